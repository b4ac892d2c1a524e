#include "core/stages/lane_masks.h"
#include "core/stages/sampled_light.h"
#include "core/techniques/wavefront.h"

namespace orrery {
namespace {

// Kajiya, "The rendering equation" (SIGGRAPH 1986): light from everywhere, along paths that are drawn. Each
// vertex draws one light source and one direction. Emission counts up to rays of the plan's depth, and light
// sources from the vertices above. From the second vertex on, paths survive with the probability of the root
// of their throughput (Russian roulette).
template <class T>
class Path final : public Wavefront<T> {
 public:
  Path(const World<T>& world, const Plan& plan)
      : Wavefront<T>(world, plan), sampled_light_(this->geometry_, this->accelerator_, this->plan_) {}

 private:
  using N = Lanes<T>;

  void shade(const Groups& met) override {
    auto& [paths, hits, surface, radiance] = *this->vertices_;
    const Geometry<T>& geometry = this->geometry_;
    sampled_light_.add_emission(*paths, hits, surface, met, radiance);
    if (paths->depth >= this->plan_.max_depth) return note_end(met);
    sampled_light_.add(*paths, this->draws(), surface,
                       groups_with(geometry, surface, met, &MaterialTraits::lit), radiance, this->counts());
    for (const auto& m : geometry.materials)
      m.kernel->sample(paths->rays, hits, surface, this->draws(), met, scatter_);
    for (const int i : met) go_on(i);
  }

  MaskOf<N> surface_lanes(int i) const {
    return mask_cast<N>(load_index<T>(this->vertices_->hits.primitive, i) !=
                        IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }

  void go_on(int i) {
    const PathBatch<T>& paths = *this->vertices_->paths;
    const N zero(T(0)), one(T(1));
    Vec3<N> throughput = paths.throughput.at(i) * scatter_.weight.at(i);
    N most = max_component(throughput);
    auto alive = surface_lanes(i) && most > zero;
    if (paths.depth > 0) {
      using std::sqrt;
      const N chance = min_first(one, max_first(N(kLeastChance), sqrt(select(alive, most, one))));
      alive = alive && this->draws().two(SampleSet::survival, i).u < chance;
      throughput = throughput * (one / chance);
    }
    if (any(alive)) this->spawn(i, alive, scatter_.direction.at(i), throughput, scatter_.pdf.at(i));
  }

  // Light that longer paths would bring is left out: the ledger has what they could carry.
  void note_end(const Groups& met) {
    for (const int i : met)
      this->note_cut(i, surface_lanes(i), max_component(this->vertices_->paths->throughput.at(i)));
  }

  static constexpr T kLeastChance = T(0.05);
  SampledLight<T> sampled_light_;
  ScatterBatch<T> scatter_;
};

}  // namespace

TechniqueType path_type() {
  return {"path",
          "Light from everywhere, along paths that are drawn (Kajiya 1986).",
          true,
          make_tracer_of<Path, float>,
          make_tracer_of<Path, double>,
          true};
}

}  // namespace orrery
