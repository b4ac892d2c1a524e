#include "core/techniques/path_tracer.h"

#include "core/lighting/emission.h"
#include "core/lighting/lane_masks.h"
#include "core/lighting/shadowed_light.h"
#include "core/lighting/specular.h"
#include "core/lighting/surfaces.h"

namespace orrery {

template <class T>
PathTracer<T>::PathTracer(const World<T>& world, const Plan& plan, Lobes followed)
    : Wavefront<T>(world, plan),
      followed_(followed),
      sampled_light_(this->geometry_, this->accelerator_, this->plan_, followed),
      has_emission_pass_(!plan.eye_passes && world.geometry->has_textured_emission.empty() &&
                         (!world.geometry->emission.empty() || world.geometry->background != Vec3<T>() ||
                          !sampled_light_.beyond().empty())),
      only_background_(has_emission_pass_ && world.geometry->emission.empty() && !this->atmosphere_) {
  if (only_background_) occluded_ = std::make_unique<RayBatch<T>>();
  if (sampled_light_.wants_diffuse_rays())
    diffuse_rays_ =
        std::make_unique<DiffuseRays<T>>(this->geometry_, this->accelerator_, this->plan_, sampled_light_);
  if (plan.reuse > 1)
    reuse_ = std::make_unique<PathReuse<T>>(this->geometry_, this->accelerator_, this->plan_);
  if (plan.clamp_indirect > 0) indirect_ = std::make_unique<Vec3Array<T>>();
}

template <class T>
void PathTracer<T>::trace_emission_only(const RayBatch<T>& camera_rays, const LaneGroups& groups, T share,
                                        TraceResult<T>& out, TraceCounts& counts) {
  auto& v = *this->vertices_;
  counts.rays.camera += active_rays(camera_rays, groups);
  if (only_background_) {
    find_any_hits(camera_rays, groups, counts);
  } else {
    reset(camera_rays, groups, v.hits);
    this->accelerator_.closest(camera_rays, groups, v.hits, counts.accelerator);
  }
  if (this->atmosphere_) this->atmosphere_->find(camera_rays, 0, v.hits, groups);
  for (const int i : groups) {
    find_materials(this->geometry_, v.hits, i, v.surface);
    Vec3<N> seen;
    if (!this->geometry_.emission.empty()) seen = emission_at(this->geometry_, v.surface, i);
    if (this->atmosphere_) seen = seen * this->atmosphere_->share(i);
    const Vec3<N> background(this->geometry_.background);
    out.radiance.put(i, out.radiance.at(i) + select(missed_lanes(v.hits, i), background, seen) * N(share));
  }
  if (sampled_light_.beyond().empty()) return;
  for (const int i : groups) v.radiance.put(i, Vec3<N>(N(T(0))));
  sampled_light_.beyond().add(camera_rays, v.hits, groups, nullptr, v.radiance);
  for (const int i : groups) out.radiance.put(i, out.radiance.at(i) + v.radiance.at(i) * N(share));
}

// Copies the rays on each call, because occlude() changes them.
template <class T>
void PathTracer<T>::find_any_hits(const RayBatch<T>& camera_rays, const LaneGroups& groups,
                                  TraceCounts& counts) {
  HitBatch<T>& hits = this->vertices_->hits;
  *occluded_ = camera_rays;
  this->accelerator_.occlude(*occluded_, groups, counts.accelerator);
  const N zero(T(0));
  for (const int i : groups) {
    const auto hit = camera_rays.t_max.at(i) > zero && occluded_->t_max.at(i) < zero;
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
    hits.primitive.put(i, mask_cast<IndexLanes<T>>(hit), IndexLanes<T>(IndexOf<T>{0}));
  }
}

template <class T>
void PathTracer<T>::shade(const LaneGroups& groups, const LaneGroups& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  const Geometry<T>& geometry = this->geometry_;
  const bool ends = paths->depth >= this->plan_.max_depth, looked = paths->depth == 0 && has_emission_pass_;
  if (looked)
    for (const int i : groups)
      radiance.put(i, Vec3<N>(N(T(0))));  // trace_emission_only() adds emission and background
  if (!with_diffuse(followed_)) {
    add_ambient(geometry, paths->rays, surface, met, ends ? Lobes::all : Lobes::diffuse, radiance);
    if (ends) add_ambient_of_mirrors(met);
  }
  if (!looked) add_emitted_radiance(groups, met);
  if (ends) return end(met);
  sampled_light_.add(*paths, this->draws(), surface,
                     groups_with(geometry, surface, met, &MaterialTraits::lit), radiance, this->counts());
  if (diffuse_rays_) diffuse_rays_->add(*paths, hits, this->draws(), surface, met, radiance, this->counts());
  scatter(met);
  if (reuse_ && paths->depth == 1)
    for (const int i : met) reuse_->keep_second(i, *paths, surface, view_independent_lanes(i));
}

template <class T>
void PathTracer<T>::add_ambient_of_mirrors(const LaneGroups& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  const Vec3<N> ambient(this->geometry_.ambient);
  const LaneGroups mirrors = groups_with(this->geometry_, surface, met, &MaterialTraits::mirrors);
  evaluate_specular(this->geometry_, false, hits, surface, mirrors, *paths, specular_);
  for (const int i : mirrors) {
    const auto mine = lanes_with(this->geometry_, surface, i, &MaterialTraits::mirrors);
    const Vec3<N> sent =
        (specular_.reflectance.at(i) + specular_.transmittance.at(i)) * specular_.filter.at(i);
    radiance.put(i, mine, radiance.at(i) + sent * ambient);
  }
}

template <class T>
void PathTracer<T>::begin() {
  if (reuse_) reuse_->begin(this->batch_draws());
  if (!indirect_) return;
  for (const int i : LaneGroups::covering(0, kBatch, kWidth<T>)) indirect_->put(i, Vec3<N>(N(T(0))));
}

template <class T>
void PathTracer<T>::finish() {
  if (reuse_) reuse_->finish(indirect_ ? *indirect_ : Wavefront<T>::sums(0), this->counts());
  if (indirect_) add_clamped();
}

template <class T>
void PathTracer<T>::add_clamped() {
  const N most(static_cast<T>(this->plan_.clamp_indirect));
  const auto kept = [&](const N& x) { return select(x > most, most, x); };  // NaN stays NaN
  Vec3Array<T>& radiance = Wavefront<T>::sums(0);
  for (const int i : LaneGroups::covering(0, kBatch, kWidth<T>)) {
    const Vec3<N> all = indirect_->at(i), some(kept(all.x), kept(all.y), kept(all.z));
    radiance.put(i, radiance.at(i) + some);
    this->clamped().put(i, all - some);
  }
}

template <class T>
void PathTracer<T>::add_emitted_radiance(const LaneGroups& groups, const LaneGroups& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  const bool second = paths->depth == 1, apart = second && (reuse_ || indirect_);
  const Vec3<N> none(N(T(0)));
  if (apart)
    for (const int i : groups) emission_.put(i, none);
  if (second && indirect_)
    for (const int i : groups) {  // radiance of missed rays counts as emission
      const auto missed = !surface_lanes(i);
      emission_.put(i, missed, radiance.at(i));
      radiance.put(i, missed, none);
    }
  sampled_light_.add_environment(*paths, hits, groups, second && indirect_ ? emission_ : radiance);
  sampled_light_.add_emission(*paths, hits, surface, met, apart ? emission_ : radiance);
  if (apart) add_emission_to_first(indirect_ ? groups : met);
}

template <class T>
void PathTracer<T>::add_emission_to_first(const LaneGroups& groups) {
  const PathBatch<T>& paths = *this->vertices_->paths;
  Vec3Array<T>& sums = Wavefront<T>::sums(0);
  for (const int i : groups)
    for (int lane = i; lane < std::min(i + kWidth<T>, paths.rays.count); ++lane) {
      const int slot = static_cast<int>(paths.slot[lane]);
      const Vec3<T> weight = reuse_ ? reuse_->weights()[slot] : paths.throughput[lane];
      sums.set(slot, sums[slot] + weight * emission_[lane]);
    }
}

template <class T>
Vec3<Lanes<T>> PathTracer<T>::first_weights(int i) const {
  const auto& slot = this->vertices_->paths->slot;
  const auto of_paths = [&](const Array<T>& of_slots) {
    return N([&](auto lane) { return of_slots[static_cast<int>(slot[i + static_cast<int>(lane)])]; });
  };
  const Vec3Array<T>& weights = reuse_->weights();
  return {of_paths(weights.x), of_paths(weights.y), of_paths(weights.z)};
}

template <class T>
MaskOf<Lanes<T>> PathTracer<T>::view_independent_lanes(int i) const {
  const SurfaceBatch<T>& surface = this->vertices_->surface;
  return surface_lanes(i) && lanes_with(this->geometry_, surface, i, &MaterialTraits::lit) &&
         !lanes_with(this->geometry_, surface, i, &MaterialTraits::glossy);
}

template <class T>
void PathTracer<T>::scatter(const LaneGroups& met) {
  const auto& v = *this->vertices_;
  sample_materials(this->geometry_, v.paths->rays, v.hits, v.surface, this->draws(), met, followed_,
                   scatter_);
  for (const int i : met) continue_path(i);
}

template <class T>
void PathTracer<T>::continue_path(int i) {
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
    constexpr T kMinChance = T(0.05);
    const N chance = min_first(one, max_first(N(kMinChance), sqrt(select(alive, most, one))));
    alive = alive && this->draws().two(SampleSet::survival, i).u < chance;
    throughput = throughput * (one / chance);
  }
  if (any(alive)) this->spawn(i, alive, scatter_.direction.at(i), throughput, scatter_.pdf.at(i));
}

template <class T>
void PathTracer<T>::end(const LaneGroups& met) {
  const PathBatch<T>& paths = *this->vertices_->paths;
  for (const int i : met) {
    Vec3<N> weight = paths.throughput.at(i);
    if (reuse_ && paths.depth > 0) weight = weight * first_weights(i);
    this->record_omitted(i, surface_lanes(i), weight);
  }
}

template class PathTracer<float>;
template class PathTracer<double>;

}  // namespace orrery
