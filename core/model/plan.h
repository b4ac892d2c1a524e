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
#include "core/model/occupied_space.h"
#include "core/model/render_settings.h"

namespace orrery {

struct AcceleratorType;
struct ChannelType;
struct TechniqueType;

inline constexpr const char* precision_name(bool double_precision) {
  return double_precision ? "double" : "float";
}

// One decision of the plan, as text for the user.
struct Decision {
  std::string subject, choice, reason;
  Bound bound;
};

// Render plan: all inputs of a render in addition to the scene. `decisions` explains the choices.
struct Plan {
  RenderSettings asked;  // value of every option: from the request, the scene or the default
  int width = 0, height = 0, samples = 1;
  CameraFrame frame;
  std::shared_ptr<const Camera> camera;
  const TechniqueType* technique = nullptr;
  std::vector<const char*> not_followed;  // light transport that is missing in this scene
  const AcceleratorType* accelerator = nullptr;
  bool try_accelerators = false;  // settle() measures whether another structure is faster
  bool double_precision = false;
  double time = 0;              // scene time, seconds
  double shutter = 0;           // length of the exposure from `time`, seconds; 0: an instant
  int max_depth = 0;            // largest depth that is traced; camera rays have depth 0
  double min_contribution = 0;  // rays with a smaller weight in every channel are not traced
  double clamp_indirect = 0;    // maximum indirect radiance of a sample, per channel; 0: no limit
  // True if an error or time budget chooses the parameter. `samples` or `min_contribution` is then the
  // maximum.
  bool free_samples = false, free_contribution = false;
  Space space = Space::linear;  // space in which errors are measured
  // Upper bound on the difference between two samples of a pixel, per channel, in radiance. Infinite if there
  // is no bound.
  double sample_range = std::numeric_limits<double>::infinity();
  // Upper bounds on the radiance error of one untraced ray: of any ray, which may be infinite, and of a ray
  // that misses `occupied`.
  Vec3d cut_range, cut_range_beyond;
  OccupiedSpace occupied;
  View view = View::picture;
  std::uint64_t seed = 0;
  bool reorder = false;  // rays are sorted before traversal
  Prediction prediction = Prediction::none;
  std::vector<const ChannelType*> channels;  // in addition to radiance
  SurfaceFields fields;                      // surface fields that stages and channels read
  // Stages of the pipeline that are enabled, and their parameters.
  bool direct_light = true;   // light sources are evaluated
  bool shadows = true;        // shadow rays are traced
  bool specular = true;       // mirrored and refracted rays are traced
  bool filters = true;        // materials absorb light inside objects
  bool media = false;         // rays know the bodies that they are inside of
  bool eye_in_media = false;  // camera rays may start inside bodies
  bool eye_passes = false;    // camera rays may pass surfaces: see MediaStage::pass()
  bool scatters = false;      // light is scattered inside bodies
  bool lens = false;          // camera rays start on a lens
  // Names of the materials if the energy account is kept, else empty.
  std::vector<std::string> energy_of;
  bool filtered = false;  // sample positions follow the requested filter
  int reuse = 1;          // paths per group that share the light of their second vertices; a power of two
  bool constant_half = false;  // parallel view and light: the half vector is computed once per batch
  int slice = 256;             // rays per pass through the stages; does not change results
  std::vector<Decision> decisions;

  // Returns the largest possible difference between the means of the two halves of a pixel's samples, in
  // `space`.
  double halves_range() const { return space == Space::display ? 1 : sample_range; }
  // Returns how far the mean of one half of `in_all` samples exceeds display white if one sample has radiance
  // sample_range and the others have 0. Returns 0 if the mean does not exceed white, and in linear space.
  double beyond_range(int in_all) const {
    return space == Space::display ? std::max(0.0, 2 * sample_range / in_all - 1) : 0;
  }

  Exposure exposure() const { return {time, time + shutter}; }
};

}  // namespace orrery
