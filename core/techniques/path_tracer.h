#pragma once

#include "core/model/material.h"
#include "core/stages/diffuse_rays.h"
#include "core/stages/path_reuse.h"
#include "core/stages/sampled_light.h"
#include "core/techniques/wavefront.h"

namespace orrery {

// Techniques that follow one path a sample: each vertex draws one light source, which lights all lobes, and
// one direction of the lobes that are followed. Emission counts up to rays of the plan's depth, and light
// sources from the vertices above. From the second vertex on, paths survive with the probability of the root
// of their throughput (Russian roulette). Where diffuse lobes are not followed, what ambient light makes
// leave them stands in for what other surfaces send them; they may draw a direction too, which finds what
// shines alone.
template <class T>
class PathTracer : public Wavefront<T> {
 public:
  // `followed`: all lobes, or all but the diffuse ones.
  PathTracer(const World<T>& world, const Plan& plan, Lobes followed);

  bool looks() const final { return looks_; }
  void look(const RayBatch<T>& camera_rays, T share, TraceResult<T>& out, TraceCounts& counts) final;

 private:
  using N = Lanes<T>;

  void begin() final;
  bool finish() final;
  Vec3Array<T>& sums(int depth) final {
    if (depth > 0 && reuse_) return reuse_->suffixes();
    return depth > 0 && indirect_ ? *indirect_ : Wavefront<T>::sums(depth);
  }
  void shade(const Groups& groups, const Groups& met) final;

  // Where smooth surfaces would mirror and refract light on.
  void add_ambient_of_mirrors(const Groups& met);
  void add_what_shines(const Groups& groups, const Groups& met);
  // Adds emission_ at second vertices to the light of the first: it is found from there by light sources as
  // well, shared by nobody, and not indirect.
  void add_emission_to_first(const Groups& groups);
  // Adds indirect light as far as Plan::clamp_indirect lets.
  void add_clamped();
  // Draws directions, and sends on what goes along them.
  void scatter(const Groups& met);
  void go_on(int i);
  // Light that longer paths would bring is left out, or ambient light stands in: the ledger has what they
  // could carry.
  void end(const Groups& met);

  MaskOf<N> surface_lanes(int i) const {
    const auto primitive = load_index<T>(this->vertices_->hits.primitive, i);
    return mask_cast<N>(primitive != IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
  // What the paths had from their first vertex, where they share what they find after it.
  Vec3<N> first_weights(int i) const;
  // Those whose light looks the same from everywhere.
  MaskOf<N> even_lanes(int i) const;

  const Lobes followed_;
  SampledLight<T> sampled_light_;
  const bool looks_;
  std::unique_ptr<DiffuseRays<T>> diffuse_rays_;  // null: there are none
  std::unique_ptr<PathReuse<T>> reuse_;           // null: paths share nothing
  std::unique_ptr<Vec3Array<T>> indirect_;        // by slot; null: it is not clamped
  ScatterBatch<T> scatter_;
  SpecularBatch<T> specular_;
  Vec3Array<T> emission_;
};

extern template class PathTracer<float>;
extern template class PathTracer<double>;

}  // namespace orrery
