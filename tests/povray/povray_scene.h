#pragma once

#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

// Export of Orrery's scenes to POV-Ray's scene description language.
namespace orrery {

// Error for a scene that POV-Ray 3.7 cannot express.
class UnsupportedFeature : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PovrayOptions {
  double aspect = 1;  // width over height
  int max_depth = 5;
  // Factor on all light sources, the ambient light and the background, because POV-Ray's images are clamped
  // at 1.
  double exposure = 1;
};

// Returns the scene for POV-Ray 3.7, exported from the JSON without any renderer code. Throws
// UnsupportedFeature. Requires a scene that load_scene accepts.
std::string povray_scene(const nlohmann::json& scene, const PovrayOptions& options);

}  // namespace orrery
