#include "core/techniques/wavefront.h"

namespace orrery {

template <class T>
Wavefront<T>::Wavefront(const World<T>& world, const Plan& plan)
    : geometry_(*world.geometry),
      accelerator_(*world.accelerator),
      plan_(plan),
      stage_(std::make_unique<Stage>()) {}

template <class T>
bool Wavefront<T>::trace(const RayBatch<T>& camera_rays, TraceResult<T>& out, TraceCounts& counts,
                         std::stop_token stop) {
  out_ = &out;
  counts_ = &counts;
  const Groups all = Groups::covering(0, kBatch, kWidth<T>);
  counts.rays.camera += active_rays(camera_rays, all);
  for (const int i : all) out.cut.put(i, N(T(0)));

  auto camera = take_batch(0);
  camera->rays = camera_rays;
  for (int i = 0; i < kBatch; ++i) camera->slot[i] = static_cast<IndexOf<T>>(i);
  for (const int i : all) camera->throughput.put(i, Vec3<N>(N(T(1))));
  waiting_.push_back(std::move(camera));
  constexpr int kLookEvery = 16;  // batches: a tree of glass in glass can grow to billions of rays
  for (int batches = 1; !waiting_.empty(); ++batches) {
    auto batch = std::move(waiting_.back());
    waiting_.pop_back();
    run(*batch);
    spare_.push_back(std::move(batch));
    if (batches % kLookEvery == 0 && stop.stop_requested()) {
      waiting_.clear();
      return false;
    }
  }
  return true;
}

template <class T>
void Wavefront<T>::run(PathBatch<T>& paths) {
  stage_->paths = &paths;
  reflected_ = take_batch(paths.depth + 1);
  refracted_ = take_batch(paths.depth + 1);
  for (int from = 0; from < paths.rays.count; from += plan_.slice)
    run_slice(Groups::covering(from, std::min(from + plan_.slice, paths.rays.count), kWidth<T>));
  if (paths.depth < kDeepestRay) {
    const auto depth = static_cast<std::size_t>(paths.depth + 1);
    counts_->rays.reflected[depth] += static_cast<std::uint64_t>(reflected_->rays.count);
    counts_->rays.refracted[depth] += static_cast<std::uint64_t>(refracted_->rays.count);
  }
  if (reflected_->rays.count + refracted_->rays.count <= kBatch) {
    reflected_->append(*refracted_);
    refracted_->rays.count = 0;
  }
  push(std::move(refracted_));
  push(std::move(reflected_));
}

template <class T>
void Wavefront<T>::run_slice(const Groups& groups) {
  const RayBatch<T>& rays = stage_->paths->rays;
  for (const int i : groups) {
    stage_->hits.t.put(i, rays.t_max.at(i));
    stage_->hits.primitive.put(i, IndexLanes<T>(kNoPrimitive));
  }
  accelerator_.closest(rays, groups, stage_->hits, counts_->accelerator);
  const Groups met = find_surfaces(groups);
  light_surfaces(groups_of(met, &MaterialTraits::lit));
  if (plan_.specular) follow_specular(groups_of(met, &MaterialTraits::mirrors));
  bring_home(groups);
}

// Background for the rays that met nothing, the surface for the others; returns the registers with a surface.
template <class T>
Groups Wavefront<T>::find_surfaces(const Groups& groups) {
  Stage& s = *stage_;
  Groups met;
  const Vec3<N> background(geometry_.background);
  const N zero(T(0));
  for (const int i : groups) {
    const IndexLanes<T> primitive = load_index<T>(s.hits.primitive, i);
    const auto missed = mask_cast<N>(primitive == kNoPrimitive);
    s.radiance.put(i, {select(missed, background.x, zero), select(missed, background.y, zero),
                       select(missed, background.z, zero)});
    if (all(missed)) continue;
    met.add(i);
    find_materials(i, primitive);
  }
  for (const auto& shapes : geometry_.shapes) shapes->surface(s.paths->rays, s.hits, met, s.surface);
  return met;
}

// Neighbours mostly meet the same primitive.
template <class T>
void Wavefront<T>::find_materials(int i, const IndexLanes<T>& primitive) {
  const auto material = [&](IndexOf<T> p) {
    return p < 0 ? -1 : geometry_.material_of[static_cast<std::size_t>(p)];
  };
  const IndexOf<T> first = primitive[0];
  if (all(primitive == first)) return stage_->surface.material.put(i, IndexLanes<T>(material(first)));
  for (int lane = i; lane < i + kWidth<T>; ++lane)
    stage_->surface.material[lane] = material(stage_->hits.primitive[lane]);
}

template <class T>
void Wavefront<T>::light_surfaces(const Groups& groups) {
  if (groups.empty()) return;
  Stage& s = *stage_;
  for (const auto& m : geometry_.materials)
    if (m.traits.lit) m.kernel->ambient(s.surface, groups, geometry_.ambient, s.radiance);
  if (!plan_.direct_light) return;
  for (const int i : groups)
    s.light.shadow.origin.put(i, s.surface.position.at(i) + s.surface.geometric.at(i) * s.surface.step.at(i));
  for (const auto& light : geometry_.scene->lights) light_from(*light, groups);
}

template <class T>
void Wavefront<T>::light_from(const Light& light, const Groups& groups) {
  Stage& s = *stage_;
  light.illuminate(s.surface, groups, s.light);
  s.light.constant_half = plan_.constant_half && s.paths->depth == 0 && light.directional();
  for (const int i : groups) s.light.shadow.t_max.put(i, !lanes_of(i, &MaterialTraits::lit), N(T(-1)));
  for (const auto& m : geometry_.materials)
    if (m.traits.lit) m.kernel->reflect(s.paths->rays, s.surface, groups, s.light);
  const Groups reached = with_active_rays(s.light.shadow, groups);
  if (plan_.shadows) {
    counts_->rays.shadow[static_cast<std::size_t>(s.paths->depth)] += active_rays(s.light.shadow, reached);
    accelerator_.occlude(s.light.shadow, reached, counts_->accelerator);
  }
  for (const int i : reached) {
    const auto seen = s.light.shadow.t_max.at(i) > N(T(0));
    s.radiance.put(i, seen, s.radiance.at(i) + s.light.radiance.at(i));
  }
}

template <class T>
void Wavefront<T>::follow_specular(const Groups& groups) {
  if (groups.empty()) return;
  Stage& s = *stage_;
  for (const auto& m : geometry_.materials)
    if (m.traits.mirrors) m.kernel->specular(s.paths->rays, s.hits, s.surface, groups, s.specular);
  if (plan_.filters)
    for (const int i : groups) {
      const auto filtered = specular_lanes(i);
      s.paths->throughput.put(i, filtered, s.paths->throughput.at(i) * s.specular.filter.at(i));
    }
  scatter(groups);
}

template <class T>
void Wavefront<T>::spawn(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction,
                         const Vec3<N>& weight) {
  Stage& s = *stage_;
  const N zero(T(0));
  const auto wanted = mask && max_component(weight) > zero;
  if (!any(wanted)) return;
  const Vec3<N> throughput = s.paths->throughput.at(i) * weight;
  auto traced = wanted;
  if (s.paths->depth >= plan_.max_depth)
    traced = typename N::mask_type(false);
  else if (plan_.min_contribution > 0)
    traced = wanted && max_component(throughput) >= N(static_cast<T>(plan_.min_contribution));
  if (!all(traced == wanted)) cut(i, wanted && !traced, weight);
  if (!any(traced)) return;
  const Vec3<N> geometric = s.surface.geometric.at(i);
  const N step = s.surface.step.at(i);
  const N signed_step = select(dot(direction, geometric) < zero, -step, step);
  const Ray<N> ray = {s.surface.position.at(i) + geometric * signed_step, direction};
  (kind == Kind::reflected ? reflected_ : refracted_)
      ->append(traced, ray, throughput, load_index<T>(s.paths->slot, i));
}

template <class T>
void Wavefront<T>::cut(int i, const MaskOf<N>& mask, const Vec3<N>& weight) {
  Stage& s = *stage_;
  s.radiance.put(i, mask, s.radiance.at(i) + weight * Vec3<N>(geometry_.ambient));
  const N lost = max_component(s.paths->throughput.at(i) * weight);
  for (unsigned bits = bits_of(mask); bits != 0; bits &= bits - 1) {
    const int lane = std::countr_zero(bits);
    out_->cut[static_cast<int>(s.paths->slot[i + lane])] += lost[static_cast<std::size_t>(lane)];
    ++counts_->cut_rays;
  }
}

template <class T>
void Wavefront<T>::bring_home(const Groups& groups) {
  Stage& s = *stage_;
  Vec3Array<T>& home = out_->radiance;
  if (s.paths->depth == 0) {
    for (const int i : groups) home.put(i, s.radiance.at(i) * s.paths->throughput.at(i));
    return;
  }
  for (const int i : groups) {
    s.radiance.put(i, s.radiance.at(i) * s.paths->throughput.at(i));
    for (int lane = i; lane < std::min(i + kWidth<T>, s.paths->rays.count); ++lane) {
      const int slot = static_cast<int>(s.paths->slot[lane]);
      home.x[slot] += s.radiance.x[lane];
      home.y[slot] += s.radiance.y[lane];
      home.z[slot] += s.radiance.z[lane];
    }
  }
}

template <class T>
MaskOf<Lanes<T>> Wavefront<T>::lanes_of(int i, bool MaterialTraits::*trait) const {
  const IndexLanes<T> material = load_index<T>(stage_->surface.material, i);
  typename N::mask_type lanes(false);
  for (const auto& m : geometry_.materials)
    if (m.traits.*trait) lanes = lanes || mask_cast<N>(material >= m.first && material < m.last);
  return lanes;
}

template <class T>
Groups Wavefront<T>::groups_of(const Groups& groups, bool MaterialTraits::*trait) const {
  Groups chosen;
  for (const int i : groups)
    if (any(lanes_of(i, trait))) chosen.add(i);
  return chosen;
}

template <class T>
std::unique_ptr<PathBatch<T>> Wavefront<T>::take_batch(int depth) {
  if (spare_.empty()) spare_.push_back(std::make_unique<PathBatch<T>>());
  auto batch = std::move(spare_.back());
  spare_.pop_back();
  batch->rays.count = 0;
  batch->depth = depth;
  return batch;
}

template <class T>
void Wavefront<T>::push(std::unique_ptr<PathBatch<T>> batch) {
  auto& where = batch->rays.count > 0 ? waiting_ : spare_;
  batch->seal();
  where.push_back(std::move(batch));
}

template class Wavefront<float>;
template class Wavefront<double>;

}  // namespace orrery
