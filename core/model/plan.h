#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/camera.h"
#include "core/model/render_settings.h"

namespace orrery {

struct AcceleratorType;
struct TechniqueType;

inline constexpr const char* precision_name(bool double_precision) {
  return double_precision ? "double" : "float";
}

// One choice the plan made, for people to read.
struct Decision {
  std::string subject, choice, reason;
};

// All that a render needs to know beside the scene: what will be modelled and, in `decisions`, why no more.
struct Plan {
  RenderSettings asked;  // every option: by the request, or else the scene, or else its default
  int width = 0, height = 0, samples = 1;
  CameraFrame camera;
  const TechniqueType* technique = nullptr;
  const AcceleratorType* accelerator = nullptr;
  bool try_accelerators = false;  // for few primitives: others may be cheaper, see settle()
  bool double_precision = false;
  double time = 0;              // of the scene's motion, seconds
  int max_depth = 0;            // deepest ray that is traced; camera rays have depth 0
  double min_contribution = 0;  // rays whose weight is below it in every channel are not traced
  std::uint64_t seed = 0;
  bool reorder = false;  // rays that are alike are asked for together
  Prediction prediction = Prediction::none;
  // Stages that are present.
  bool direct_light = true;    // light sources are evaluated
  bool shadows = true;         // shadow rays are traced
  bool specular = true;        // mirrored and refracted rays
  bool filters = true;         // bodies weaken the light that crosses them
  bool constant_half = false;  // with parallel viewer and light, the half vector is computed once a batch
  int slice = 256;             // rays that pass through the stages together; changes no result
  std::vector<Decision> decisions;
};

}  // namespace orrery
