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

// Decision of the plan, in text for the user.
struct Decision {
  std::string subject, choice, reason;
  Bound bound;
};

// Render plan: all inputs of a render in addition to the scene. `decisions` explain its choices.
struct Plan {
  RenderSettings asked;  // every option: from the request, the scene, or the default
  int width = 0, height = 0, samples = 1;
  CameraFrame frame;
  std::shared_ptr<const Camera> camera;
  const TechniqueType* technique = nullptr;
  std::vector<const char*> not_followed;  // kinds of light that the technique misses in this scene
  const AcceleratorType* accelerator = nullptr;
  bool try_accelerators = false;  // few primitives: another structure may be cheaper, see settle()
  bool double_precision = false;
  double time = 0;              // scene time, seconds
  double shutter = 0;           // exposure after `time`, seconds; 0: an instant
  int max_depth = 0;            // largest depth that is traced; camera rays: 0
  double min_contribution = 0;  // rays with a smaller weight in every channel are not traced
  double clamp_indirect = 0;    // limit of a sample's indirect radiance, per channel; 0: none
  // Parameters that an error or time budget chooses.
  bool free_samples = false, free_contribution = false;  // `samples` is then the maximum
  Space space = Space::linear;                           // space that errors are measured in
  // Upper bound of the difference between samples of a pixel, per channel, in radiance; infinite if
  // unbounded.
  double sample_range = std::numeric_limits<double>::infinity();
  Vec3d cut_range;  // upper bound of the change of radiance by an untraced ray; may be infinite
  View view = View::picture;
  std::uint64_t seed = 0;
  bool reorder = false;  // similar rays are traced together
  Prediction prediction = Prediction::none;
  std::vector<const ChannelType*> channels;  // in addition to radiance
  SurfaceFields fields;                      // surface fields that stages and channels read
  // Stages of the pipeline.
  bool direct_light = true;  // light sources are evaluated
  bool shadows = true;       // shadow rays are traced
  bool specular = true;      // mirrored and refracted rays are traced
  bool filters = true;       // bodies absorb the light that crosses them
  bool lens = false;         // camera rays start on a lens
  bool filtered = false;     // samples are distributed by the requested filter
  int reuse = 1;             // paths per group that share the light of their second vertices; a power of two
  bool constant_half = false;  // parallel view and light: the half vector is computed once per batch
  int slice = 256;             // rays that pass through the stages together; does not change results
  std::vector<Decision> decisions;

  // Returns the largest possible difference between the halves of a pixel's samples, in the space of errors.
  double halves_range() const { return space == Space::display ? 1 : sample_range; }
  // Returns how far a half may exceed display white if one of `in_all` samples is bright; 0 in linear space.
  double beyond_range(int in_all) const {
    return space == Space::display ? std::max(0.0, 2 * sample_range / in_all - 1) : 0;
  }

  Exposure exposure() const { return {time, time + shutter}; }
};

}  // namespace orrery
