#pragma once

#include <vector>

#include "core/model/channel.h"
#include "core/model/counts.h"
#include "core/model/draws.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// Result of one batch of camera rays. Only indirect radiance is clamped: see Plan::clamp_indirect.
template <class T>
struct TraceResult {
  Vec3Array<T> radiance;
  // Upper bound on the radiance error of untraced rays, per channel: the sum of their throughputs times
  // Plan::cut_range.
  Vec3Array<T> omitted;
  Vec3Array<T> clamped;  // radiance removed by clamping; filled only if Plan::clamp_indirect > 0
  std::vector<ChannelBatch<T>> channels;  // in the order of Plan::channels
};

// Maximum number of emission-only camera rays per sample: see Tracer::has_emission_pass().
inline constexpr int kMaxEmissionSamples = 16;

// Light transport algorithm. A tracer is not thread-safe. A thread should reuse its tracer, because the
// batches are allocated once per tracer.
template <class T>
class Tracer {
 public:
  virtual ~Tracer() = default;
  // Called before trace() with the tile and the sample positions of its camera rays. Both must stay valid
  // during trace(). REQUIRES: World::screen is set.
  virtual void place(const TileView& /*tile*/, const TileSamples& /*samples*/) {}
  // Traces the camera rays and all rays that they spawn. Inactive rays count as rays that miss everything.
  // `draws` returns the random numbers of the sample. Calls checkpoint(). After an exception, the results are
  // undefined.
  virtual void trace(const RayBatch<T>& camera_rays, const Draws& draws, TraceResult<T>& out,
                     TraceCounts& counts) = 0;

  // Returns true if trace() omits the directly visible emission and background. The caller then adds both by
  // trace_emission_only(), with separate camera rays. Emitters have the sharpest edges of an image, and
  // emission-only rays are cheap.
  virtual bool has_emission_pass() const { return false; }
  // Adds `share` times the emission at the first hit of each camera ray of `groups`, or `share` times the
  // background if the ray misses.
  virtual void trace_emission_only(const RayBatch<T>& /*camera_rays*/, const LaneGroups& /*groups*/,
                                   T /*share*/, TraceResult<T>& /*out*/, TraceCounts& /*counts*/) {}
};

template <class T>
using TracerPtr = std::unique_ptr<Tracer<T>>;

// Type of light transport algorithm. The plan and the objects that the world refers to must outlive the
// tracer.
struct TechniqueType {
  const char* name;
  const char* summary;
  const char* origin;           // author and year of the publication
  int max_depth;                // default; a request or a scene may set another value
  bool secondary_rays = false;  // follows mirrored and refracted rays
  // Samples one light source and one direction per vertex. Emitting surfaces and the environment are then
  // light sources, and lenses cause defocus blur.
  bool draws_light = false;
  // Finds visible surfaces by a z-buffer of triangles instead of camera rays. Needs World::screen. No ray
  // starts at a surface, and nothing casts shadows.
  bool rasterizes = false;
  bool interreflects = false;                  // diffuse interreflection replaces ambient light
  std::vector<const char*> not_followed = {};  // light transport missing in every scene
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
