#pragma once

#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

// Our scenes in POV-Ray's scene description language.
namespace orrery {

// A scene says something that POV-Ray 3.7 has no words for.
class Inexpressible : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PovrayOptions {
  double aspect = 1;  // width over height
  int max_depth = 5;
  // Every light source, the ambient light and the background are multiplied by it: POV-Ray's pictures end
  // at 1.
  double exposure = 1;
};

// The same scene for POV-Ray 3.7, written from the JSON alone: nothing of the renderer that it checks takes
// part. Throws Inexpressible. REQUIRES: load_scene accepts the scene.
std::string povray_scene(const nlohmann::json& scene, const PovrayOptions& options);

}  // namespace orrery
