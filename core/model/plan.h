#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/exposure.h"
#include "core/model/bound.h"
#include "core/model/camera.h"
#include "core/model/render_settings.h"

namespace orrery {

struct AcceleratorType;
struct ChannelType;
struct TechniqueType;

inline constexpr const char* precision_name(bool double_precision) {
  return double_precision ? "double" : "float";
}

// One choice the plan made, for people to read.
struct Decision {
  std::string subject, choice, reason;
  Bound bound;
};

// All that a render needs to know beside the scene: what will be modelled and, in `decisions`, why no more.
struct Plan {
  RenderSettings asked;  // every option: by the request, or else the scene, or else its default
  int width = 0, height = 0, samples = 1;
  CameraFrame frame;
  std::shared_ptr<const Camera> camera;
  const TechniqueType* technique = nullptr;
  std::vector<const char*> not_followed;  // kinds of light that the technique does not find in this scene
  const AcceleratorType* accelerator = nullptr;
  bool try_accelerators = false;  // for few primitives: others may be cheaper, see settle()
  bool double_precision = false;
  double time = 0;              // of the scene's motion, seconds
  double shutter = 0;           // seconds that the shutter is open from then on; 0: an instant
  int max_depth = 0;            // deepest ray that is traced; camera rays have depth 0
  double min_contribution = 0;  // rays whose weight is below it in every channel are not traced
  double clamp_indirect = 0;    // what second vertices bring to a sample is cut to it, per channel; 0: is not
  // Of the picture until whose error or time it is made: what is left to that.
  bool free_samples = false, free_contribution = false;  // samples are then the most that may be traced
  Space space = Space::linear;                           // that errors are told in
  // Within which all samples of a pixel lie, as a difference, per channel, in radiance; infinite if nothing
  // limits them.
  double sample_range = std::numeric_limits<double>::infinity();
  Vec3d cut_range;  // the most by which a ray that is not traced may change radiance; may be infinite
  View view = View::picture;
  std::uint64_t seed = 0;
  bool reorder = false;  // rays that are alike are asked for together
  Prediction prediction = Prediction::none;
  std::vector<const ChannelType*> channels;  // beside radiance
  SurfaceFields fields;                      // what stages and channels read of surfaces
  // Stages that are present.
  bool direct_light = true;  // light sources are evaluated
  bool shadows = true;       // shadow rays are traced
  bool specular = true;      // mirrored and refracted rays
  bool filters = true;       // bodies weaken the light that crosses them
  bool lens = false;         // camera rays leave from a lens
  bool filtered = false;     // samples lie as the filter that was asked for has them
  int reuse = 1;             // paths of a tile that share what their second vertices receive; a power of two
  bool constant_half = false;  // with parallel viewer and light, the half vector is computed once a batch
  int slice = 256;             // rays that pass through the stages together; changes no result
  std::vector<Decision> decisions;

  // By how much the halves of a pixel's samples may differ in the space of errors.
  double halves_range() const { return space == Space::display ? 1 : sample_range; }
  // By how much one of them may exceed what a display shows when one sample of so many in all is bright.
  double beyond_range(int in_all) const {
    return space == Space::display ? std::max(0.0, 2 * sample_range / in_all - 1) : 0;
  }

  Exposure exposure() const { return {time, time + shutter}; }
};

}  // namespace orrery
