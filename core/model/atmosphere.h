#pragma once

#include <memory>

#include "core/model/camera.h"
#include "core/model/rounding.h"

// Atmospheres: changes of light between surfaces, and between surfaces and the eye.
namespace orrery {

class Params;

// Atmosphere in one number type. The radiance at the origin of a ray is s L + (1 - s) C, where L is the
// radiance at the hit, s the share that arrives, and C Atmosphere::color(). Immutable and thread-safe.
template <class T>
class AtmosphereKernel {
 public:
  virtual ~AtmosphereKernel() = default;
  // Sets the shares, in [0, 1], of the rays of `groups` that hit something. `depth` is PathBatch::depth.
  virtual void transmit(const CameraFrame& frame, const RayBatch<T>& rays, int depth, const HitBatch<T>& hits,
                        const LaneGroups& groups, Array<T>& share) const = 0;
  // Multiplies the light of light sources by the share that arrives over `distance` metres. Does nothing in
  // lanes whose distance is infinite or not positive.
  virtual void transmit_light(const Array<T>& /*distance*/, const LaneGroups&,
                              Vec3Array<T>& /*incident*/) const {}
};

template <class T>
using AtmosphereKernelPtr = std::unique_ptr<AtmosphereKernel<T>>;

// Atmosphere of a scene. Immutable and thread-safe.
class Atmosphere {
 public:
  virtual ~Atmosphere() = default;
  virtual const char* type() const = 0;
  virtual Vec3d color() const = 0;  // radiance that replaces the removed light
  // Returns true if rays that leave the scene receive color(). Otherwise they see the background.
  virtual bool hides_background() const = 0;
  virtual RoundingLimit rounding() const { return {}; }
  virtual AtmosphereKernelPtr<float> kernel(float) const = 0;
  virtual AtmosphereKernelPtr<double> kernel(double) const = 0;
};

struct AtmosphereType {
  const char* name;
  const char* summary;
  std::shared_ptr<const Atmosphere> (*read)(Params&);  // records problems of the input in the Params
};

}  // namespace orrery
