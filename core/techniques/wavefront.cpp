#include "core/techniques/wavefront.h"

#include "core/base/task_scope.h"
#include "core/lighting/deposit.h"
#include "core/lighting/lane_masks.h"
#include "core/lighting/surfaces.h"

namespace orrery {

template <class T>
Wavefront<T>::Wavefront(const World<T>& world, const Plan& plan)
    : geometry_(*world.geometry),
      accelerator_(*world.accelerator),
      plan_(plan),
      vertices_(std::make_unique<Vertices>()) {
  if (geometry_.atmosphere) atmosphere_ = std::make_unique<AtmosphereStage<T>>(geometry_, plan_);
  if (!plan.energy_of.empty()) energy_ = std::make_unique<EnergyAccount<T>>(geometry_);
  if (plan.media) media_ = std::make_unique<MediaStage<T>>(geometry_, accelerator_, plan_);
}

template <class T>
void Wavefront<T>::trace(const RayBatch<T>& camera_rays, const Draws& draws, TraceResult<T>& out,
                         TraceCounts& counts) {
  draws_ = &draws;
  out_ = &out;
  counts_ = &counts;
  waiting_.clear();  // not empty after an exception
  start(camera_rays);
  begin();
  while (!waiting_.empty()) {
    auto batch = std::move(waiting_.back());
    waiting_.pop_back();
    run(*batch);
    spare_.push_back(std::move(batch));
    checkpoint();  // after each batch, because nested glass can spawn a tree of billions of rays
  }
  finish();
}

template <class T>
void Wavefront<T>::start(const RayBatch<T>& camera_rays) {
  const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<T>);
  counts_->rays.camera += active_rays(camera_rays, all);
  out_->channels.resize(plan_.channels.size());
  auto camera = take_batch(0);
  camera->rays.count = camera_rays.count;
  camera->rays.origin = camera_rays.origin;
  camera->rays.direction = camera_rays.direction;
  camera->rays.t_max = camera_rays.t_max;
  if (plan_.shutter > 0) time_ = camera_rays.time;
  for (int i = 0; i < kBatch; ++i) camera->slot[i] = static_cast<IndexOf<T>>(i);
  for (const int i : all) {
    out_->omitted.put(i, Vec3<N>(N(T(0))));
    camera->throughput.put(i, Vec3<N>(N(T(1))));
  }
  if (plan_.fields.footprint) {
    const PixelFootprint pixel = pixel_footprint(plan_.frame, *plan_.camera, plan_.height);
    for (const int i : all) {
      camera->width.put(i, N(static_cast<T>(pixel.width)));
      camera->spread.put(i, N(static_cast<T>(pixel.spread)));
    }
  }
  if (media_) {
    if (plan_.shutter > 0) inherit_times(*camera);
    media_->start(*camera, *counts_);
  }
  waiting_.push_back(std::move(camera));
}

template <class T>
void Wavefront<T>::run(PathBatch<T>& paths) {
  vertices_->paths = &paths;
  if (plan_.shutter > 0) inherit_times(paths);
  reflected_ = take_batch(paths.depth + 1);
  refracted_ = take_batch(paths.depth + 1);
  for (int from = 0; from < paths.rays.count; from += plan_.slice)
    run_slice(LaneGroups::covering(from, std::min(from + plan_.slice, paths.rays.count), kWidth<T>));
  if (paths.depth < kMaxRayDepth) {
    const auto depth = static_cast<std::size_t>(paths.depth + 1);
    counts_->rays.reflected[depth] += static_cast<std::uint64_t>(reflected_->rays.count);
    counts_->rays.refracted[depth] += static_cast<std::uint64_t>(refracted_->rays.count);
  }
  if (reflected_->rays.count + refracted_->rays.count <= kBatch) {
    reflected_->append(*refracted_, plan_.fields.footprint);
    refracted_->rays.count = 0;
  }
  push(std::move(refracted_));
  push(std::move(reflected_));
}

template <class T>
void Wavefront<T>::inherit_times(PathBatch<T>& paths) const {
  const int room = (paths.rays.count + kWidth<T> - 1) / kWidth<T> * kWidth<T>;
  for (int i = 0; i < room; ++i) paths.rays.time[i] = time_[static_cast<int>(paths.slot[i])];
}

template <class T>
void Wavefront<T>::run_slice(const LaneGroups& groups) {
  Vertices& v = *vertices_;
  PathBatch<T>& paths = *v.paths;
  const LaneGroups met = find_vertices(groups);
  if (paths.depth == 0) record_channels(groups, met);
  if (energy_) energy_->add(paths, v.hits, v.surface, draws(), met, *counts_);
  if (atmosphere_) atmosphere_->enter(v.hits, v.surface, groups, met, paths);
  shade(groups, met);
  if (atmosphere_) atmosphere_->leave(groups, paths, v.radiance);
  deposit(paths, groups, v.radiance, sums(paths.depth));
}

template <class T>
LaneGroups Wavefront<T>::find_vertices(const LaneGroups& groups) {
  Vertices& v = *vertices_;
  reset(v.paths->rays, groups, v.hits);
  accelerator_.closest(v.paths->rays, groups, v.hits, counts_->accelerator);
  const LaneGroups met =
      find_surfaces(geometry_, plan_.fields, *v.paths, groups, v.hits, v.surface, v.radiance);
  if (!media_) return met;
  const LaneGroups passed = media_->pass(*v.paths, groups, draws(), v.hits, v.surface, v.radiance, *counts_);
  media_->for_each_omitted([&](int lane, const Vec3<T>& throughput) {
    typename N::mask_type mask(false);
    mask[static_cast<std::size_t>(lane % kWidth<T>)] = true;
    record_omitted(lane - lane % kWidth<T>, mask, Vec3<N>(throughput));
  });
  return passed;
}

template <class T>
void Wavefront<T>::record_channels(const LaneGroups& groups, const LaneGroups& met) {
  const Vertices& v = *vertices_;
  for (const int i : met)
    counts_->camera_hits += static_cast<std::uint64_t>(stdx::popcount(!missed_lanes(v.hits, i)));
  const N zero(T(0)), one(T(1));
  for (std::size_t c = 0; c < plan_.channels.size(); ++c) {
    ChannelBatch<T>& channel = out_->channels[c];
    plan_.channels[c]->record(FirstHits<T>{*v.paths, v.hits, v.surface}, met, channel.value);
    for (const int i : groups) channel.weight.put(i, select(missed_lanes(v.hits, i), zero, one));
  }
}

template <class T>
unsigned Wavefront<T>::spawn(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction,
                             const Vec3<N>& throughput) {
  const Vertices& v = *vertices_;
  const Ray<N> ray = {v.surface.origin_toward(i, direction), direction};
  PathBatch<T>& into = kind == Kind::reflected ? *reflected_ : *refracted_;
  const unsigned bits = into.append(mask, ray, throughput, load_index<T>(v.paths->slot, i));
  if (plan_.fields.footprint) into.append_footprint(bits, v.surface.footprint.at(i), v.paths->spread.at(i));
  if (media_) media_->inherit(*v.paths, i, dot(direction, v.surface.geometric.at(i)) < N(T(0)), bits, into);
  return bits;
}

template <class T>
void Wavefront<T>::spawn(int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& throughput,
                         const N& pdf) {
  reflected_->append_pdf(spawn(Kind::reflected, i, mask, direction, throughput), pdf);
}

template <class T>
void Wavefront<T>::record_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight) {
  add_omitted(i, mask, weight, plan_.cut_range);
}

template <class T>
void Wavefront<T>::record_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight,
                                  const Vec3<N>& direction) {
  const Vec3<N> origin = vertices_->surface.origin_toward(i, direction);
  MaskOf<N> beyond(false);
  for (unsigned bits = bits_of(mask); bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    const auto at = [&](const Vec3<N>& v) {
      return Vec3d(double{v.x[lane]}, double{v.y[lane]}, double{v.z[lane]});
    };
    beyond[lane] = plan_.occupied.is_missed(at(origin), at(direction));
  }
  add_omitted(i, mask && beyond, weight, plan_.cut_range_beyond);
  add_omitted(i, mask && !beyond, weight, plan_.cut_range);
}

template <class T>
void Wavefront<T>::add_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight,
                               const Vec3d& most_of_ray) {
  const Vec3<T> range(most_of_ray);
  // Avoids 0 * infinity.
  const auto product = [](T share, T most) { return share > 0 ? share * most : T(0); };
  for (unsigned bits = bits_of(mask); bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    const int slot = static_cast<int>(vertices_->paths->slot[i + static_cast<int>(lane)]);
    const Vec3<T> most(product(weight.x[lane], range.x), product(weight.y[lane], range.y),
                       product(weight.z[lane], range.z));
    out_->omitted.set(slot, out_->omitted[slot] + most);
    ++counts_->cut_rays;
  }
}

template <class T>
std::unique_ptr<PathBatch<T>> Wavefront<T>::take_batch(int depth) {
  if (spare_.empty()) spare_.push_back(std::make_unique<PathBatch<T>>());
  auto batch = std::move(spare_.back());
  spare_.pop_back();
  if (media_ && !batch->media) batch->media = std::make_unique<MediaLists>();
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
