#pragma once

#include <vector>

#include "core/base/checkpoint.h"
#include "core/model/channel.h"
#include "core/model/counts.h"
#include "core/model/draws.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// What the camera rays of one batch found, by slot. Not averaged, not clamped.
template <class T>
struct TraceResult {
  Vec3Array<T> radiance;
  // The ledger of what was left out: the most by which it may change radiance, per channel. Of rays that were
  // not traced the weight times Plan::cut_range.
  Vec3Array<T> omitted;
  Vec3Array<T> clamped;                   // radiance that Plan::clamp_indirect took away, if that is above 0
  std::vector<ChannelBatch<T>> channels;  // of Plan::channels, in that order
};

inline constexpr int kMostLooks = 16;  // rays a sample that only look: see Tracer::looks()

// How light is followed. One tracer belongs to one thread and is used again and again; it keeps its batches.
template <class T>
class Tracer {
 public:
  virtual ~Tracer() = default;
  // Follows the camera rays to the end. Slots of inactive rays get the background. `draws` has the random
  // numbers of the batch's slots. `checkpoint` is asked now and then; once the work is to end the rest is
  // left, the result means nothing and false is returned.
  virtual bool trace(const RayBatch<T>& camera_rays, const Draws& draws, TraceResult<T>& out,
                     TraceCounts& counts, const Checkpoint& checkpoint = {}) = 0;

  // Whether what shines by itself is found by look() alone, with camera rays elsewhere within the pixels: it
  // has the sharpest edges of a picture, and a ray that only looks costs little.
  virtual bool looks() const { return false; }
  // Adds `share` of the light of surfaces that emit, and of the background, that the rays meet first.
  virtual void look(const RayBatch<T>& /*camera_rays*/, T /*share*/, TraceResult<T>& /*out*/,
                    TraceCounts& /*counts*/) {}
};

template <class T>
using TracerPtr = std::unique_ptr<Tracer<T>>;

// The plan and what the world refers to outlive the tracer.
struct TechniqueType {
  const char* name;
  const char* summary;
  int max_depth;                // unless a request or a scene tells
  bool secondary_rays = false;  // follows mirrored and refracted rays
  // One light source and one direction a vertex are drawn: surfaces that emit and the environment are light
  // sources, and lenses blur.
  bool draws_light = false;
  bool interreflects = false;                  // diffuse surfaces light each other, in place of ambient light
  std::vector<const char*> not_followed = {};  // kinds of light that its pictures lack, whatever the scene
  TracerPtr<float> (*make_float)(const World<float>&, const Plan&);
  TracerPtr<double> (*make_double)(const World<double>&, const Plan&);
};

template <template <class> class Derived, class T>
TracerPtr<T> make_tracer_of(const World<T>& world, const Plan& plan) {
  return std::make_unique<Derived<T>>(world, plan);
}

template <class T>
TracerPtr<T> make_tracer(const TechniqueType& type, const World<T>& world, const Plan& plan) {
  if constexpr (std::is_same_v<T, float>)
    return type.make_float(world, plan);
  else
    return type.make_double(world, plan);
}

}  // namespace orrery
