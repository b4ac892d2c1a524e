#include "core/stages/emission.h"
#include "core/stages/lane_masks.h"
#include "core/stages/path_reuse.h"
#include "core/stages/sampled_light.h"
#include "core/stages/surfaces.h"
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
      : Wavefront<T>(world, plan),
        sampled_light_(this->geometry_, this->accelerator_, this->plan_),
        looks_(!world.geometry->emission.empty() || world.geometry->background != Vec3<T>() ||
               !sampled_light_.beyond().empty()) {
    if (plan.reuse > 1)
      reuse_ = std::make_unique<PathReuse<T>>(this->geometry_, this->accelerator_, this->plan_);
  }

 private:
  using N = Lanes<T>;

  void begin() override {
    if (reuse_) reuse_->begin(this->batch_draws());
  }
  bool finish() override {
    return !reuse_ || reuse_->finish(Wavefront<T>::sums(0), this->counts(), this->checkpoint());
  }
  Vec3Array<T>& sums(int depth) override {
    return reuse_ && depth > 0 ? reuse_->suffixes() : Wavefront<T>::sums(depth);
  }

  bool looks() const override { return looks_; }
  void look(const RayBatch<T>& camera_rays, T share, TraceResult<T>& out, TraceCounts& counts) override {
    auto& v = *this->vertices_;
    const Groups all = Groups::covering(0, kBatch, kWidth<T>);
    counts.rays.camera += active_rays(camera_rays, all);
    reset(camera_rays, all, v.hits);
    this->accelerator_.closest(camera_rays, all, v.hits, counts.accelerator);
    for (const int i : all) {
      const auto missed =
          mask_cast<N>(load_index<T>(v.hits.primitive, i) == IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
      find_materials(this->geometry_, v.hits, i, v.surface);
      Vec3<N> seen;
      if (!this->geometry_.emission.empty()) seen = emission_at(this->geometry_, v.surface, i);
      const Vec3<N> background(this->geometry_.background);
      out.radiance.put(i, out.radiance.at(i) + select(missed, background, seen) * N(share));
    }
    if (sampled_light_.beyond().empty()) return;
    for (const int i : all) v.radiance.put(i, Vec3<N>(N(T(0))));
    sampled_light_.beyond().add(camera_rays, v.hits, all, nullptr, v.radiance);
    for (const int i : all) out.radiance.put(i, out.radiance.at(i) + v.radiance.at(i) * N(share));
  }

  void shade(const Groups& groups, const Groups& met) override {
    auto& [paths, hits, surface, radiance] = *this->vertices_;
    const Geometry<T>& geometry = this->geometry_;
    if (paths->depth == 0 && looks_)
      for (const int i : groups) radiance.put(i, Vec3<N>(N(T(0))));  // look() finds it
    else
      add_what_shines(groups, met);
    if (paths->depth >= this->plan_.max_depth) return note_end(met);
    sampled_light_.add(*paths, this->draws(), surface,
                       groups_with(geometry, surface, met, &MaterialTraits::lit), radiance, this->counts());
    for (const auto& m : geometry.materials)
      m.kernel->sample(paths->rays, hits, surface, this->draws(), met, Lobes::all, scatter_);
    for (const int i : met) go_on(i);
    if (reuse_ && paths->depth == 1)
      for (const int i : met) reuse_->keep_second(i, *paths, surface, even_lanes(i));
  }

  void add_what_shines(const Groups& groups, const Groups& met) {
    auto& [paths, hits, surface, radiance] = *this->vertices_;
    sampled_light_.add_beyond(*paths, hits, groups, radiance);
    if (reuse_ && paths->depth == 1)
      add_emission_alone(met);
    else
      sampled_light_.add_emission(*paths, hits, surface, met, radiance);
  }

  // What a second vertex sends out by itself is found from the first vertex by its light sources as well, and
  // shared by nobody.
  void add_emission_alone(const Groups& met) {
    const auto& v = *this->vertices_;
    for (const int i : met) emission_.put(i, Vec3<N>(N(T(0))));
    sampled_light_.add_emission(*v.paths, v.hits, v.surface, met, emission_);
    for (const int i : met)
      for (int lane = i; lane < std::min(i + kWidth<T>, v.paths->rays.count); ++lane) {
        const int slot = static_cast<int>(v.paths->slot[lane]);
        Vec3Array<T>& sums = Wavefront<T>::sums(0);
        sums.set(slot, sums[slot] + reuse_->weights()[slot] * emission_[lane]);
      }
  }

  MaskOf<N> surface_lanes(int i) const {
    const auto primitive = load_index<T>(this->vertices_->hits.primitive, i);
    return mask_cast<N>(primitive != IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
  // Those whose light looks the same from everywhere.
  MaskOf<N> even_lanes(int i) const {
    const SurfaceBatch<T>& surface = this->vertices_->surface;
    return surface_lanes(i) && lanes_with(this->geometry_, surface, i, &MaterialTraits::lit) &&
           !lanes_with(this->geometry_, surface, i, &MaterialTraits::glossy);
  }

  void go_on(int i) {
    const PathBatch<T>& paths = *this->vertices_->paths;
    const N zero(T(0)), one(T(1));
    Vec3<N> throughput = paths.throughput.at(i) * scatter_.weight.at(i);
    N most = max_component(throughput);
    auto alive = surface_lanes(i) && most > zero;
    if (paths.depth == 0 && reuse_) {
      reuse_->keep_first(
          i, paths, this->vertices_->surface, scatter_, alive, alive && scatter_.pdf.at(i) > zero,
          surface_lanes(i) && lanes_with(this->geometry_, this->vertices_->surface, i, &MaterialTraits::lit));
      throughput = Vec3<N>(one);
    }
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
    for (const int i : met) this->note_cut(i, surface_lanes(i), this->vertices_->paths->throughput.at(i));
  }

  static constexpr T kLeastChance = T(0.05);
  SampledLight<T> sampled_light_;
  const bool looks_;
  std::unique_ptr<PathReuse<T>> reuse_;  // null: paths share nothing
  ScatterBatch<T> scatter_;
  Vec3Array<T> emission_;
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
