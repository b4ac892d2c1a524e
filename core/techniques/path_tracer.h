#pragma once

#include "core/lighting/diffuse_rays.h"
#include "core/lighting/lane_masks.h"
#include "core/lighting/sampled_light.h"
#include "core/model/material.h"
#include "core/reuse/path_reuse.h"
#include "core/techniques/wavefront.h"

namespace orrery {

// Base of techniques that follow one path per sample. Each vertex samples one light source, for all lobes,
// and one direction of the followed lobes. Emission is added up to depth Plan::max_depth, sampled light up to
// depth Plan::max_depth - 1. From the second vertex on, the survival probability of a path is the square root
// of the largest throughput component, clamped to [0.05, 1] (Russian roulette). If diffuse lobes are not
// followed, reflected ambient light replaces interreflection. DiffuseRays then adds the emitted light that
// light sampling misses.
template <class T>
class PathTracer : public Wavefront<T> {
 public:
  // `followed` is Lobes::all or Lobes::non_diffuse.
  PathTracer(const World<T>& world, const Plan& plan, Lobes followed);

  bool has_emission_pass() const final { return has_emission_pass_; }
  void trace_emission_only(const RayBatch<T>& camera_rays, const LaneGroups& groups, T share,
                           TraceResult<T>& out, TraceCounts& counts) final;

 private:
  using N = Lanes<T>;

  void begin() final;
  void finish() final;
  Vec3Array<T>& sums(int depth) final {
    if (depth > 0 && reuse_) return reuse_->suffixes();
    return depth > 0 && indirect_ ? *indirect_ : Wavefront<T>::sums(depth);
  }
  void shade(const LaneGroups& groups, const LaneGroups& met) final;

  // Sets the hits of rays that hit any surface to the first primitive, and of others to none.
  void find_any_hits(const RayBatch<T>& camera_rays, const LaneGroups& groups, TraceCounts& counts);
  // Adds ambient light in place of the light that specular surfaces would mirror and refract.
  void add_ambient_of_mirrors(const LaneGroups& met);
  void add_emitted_radiance(const LaneGroups& groups, const LaneGroups& met);
  // Adds emission_ of second vertices to the sums of the camera rays. First vertices sample this light too.
  // It is therefore direct light, which is neither shared nor clamped.
  void add_emission_to_first(const LaneGroups& groups);
  // Adds indirect light, clamped to Plan::clamp_indirect, and records the excess as clamped().
  void add_clamped();
  // Samples directions and spawns the rays along them.
  void scatter(const LaneGroups& met);
  void continue_path(int i);
  // Ends the paths at the depth limit. Light of longer paths is left out or replaced by ambient light, and an
  // upper bound on the omitted light is recorded.
  void end(const LaneGroups& met);

  MaskOf<N> surface_lanes(int i) const { return !missed_lanes(this->vertices_->hits, i); }
  // Returns the weights of the directions sampled at the first vertices, for the paths in register i. The
  // throughput of these paths excludes the weights. REQUIRES: path reuse.
  Vec3<N> first_weights(int i) const;
  // Returns the lanes whose reflected light does not depend on the view.
  MaskOf<N> view_independent_lanes(int i) const;

  const Lobes followed_;
  SampledLight<T> sampled_light_;
  const bool has_emission_pass_;           // false if camera rays may pass surfaces: see MediaStage::pass()
  const bool only_background_;             // no surface emits, so the emission pass asks for any hit only
  std::unique_ptr<RayBatch<T>> occluded_;  // null unless only_background_
  std::unique_ptr<DiffuseRays<T>> diffuse_rays_;  // null unless SampledLight::wants_diffuse_rays()
  std::unique_ptr<PathReuse<T>> reuse_;           // null without path reuse
  std::unique_ptr<Vec3Array<T>> indirect_;        // by camera ray; null without clamping
  ScatterBatch<T> scatter_;
  SpecularBatch<T> specular_;
  Vec3Array<T> emission_;
};

extern template class PathTracer<float>;
extern template class PathTracer<double>;

}  // namespace orrery
