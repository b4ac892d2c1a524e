#pragma once

#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

// Export of our scenes to POV-Ray's scene description language.
namespace orrery {

// Error for a scene that POV-Ray 3.7 cannot express.
class UnsupportedFeature : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PovrayOptions {
  double aspect = 1;  // width over height
  int max_depth = 5;
  // Factor on every light source, the ambient light and the background, since POV-Ray's images end at 1.
  double exposure = 1;
};

// Returns the scene for POV-Ray 3.7, exported from the JSON alone, without any renderer code. Throws
// Inexpressible. Requires a scene that load_scene accepts.
std::string povray_scene(const nlohmann::json& scene, const PovrayOptions& options);

}  // namespace orrery
