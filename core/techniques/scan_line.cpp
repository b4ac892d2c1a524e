#include "core/techniques/scan_line.h"

#include <algorithm>

#include "core/lighting/specular.h"
#include "core/lighting/surfaces.h"
#include "core/math/lane_vectors.h"

namespace orrery {
namespace {

// Elements from i on, as fewer lanes than a register of T has.
template <class Narrow, class T>
[[gnu::always_inline]] inline Vec3<Narrow> loaded(const Vec3Array<T>& from, int i) {
  const auto load = [&](const Array<T>& values) { return Narrow(&values[i], stdx::vector_aligned); };
  return {load(from.x), load(from.y), load(from.z)};
}
template <class Narrow, class T>
[[gnu::always_inline]] inline void store(int i, Vec3Array<T>& to, const Vec3<Narrow>& v) {
  to.x.put(i, v.x);
  to.y.put(i, v.y);
  to.z.put(i, v.z);
}

}  // namespace

template <class T>
ScanLine<T>::ScanLine(const World<T>& world, const Plan& plan, ShadingPoints points)
    : SpecularTree<T>(world, plan),
      screen_(*world.screen),
      shading_(points),
      has_straight_(world.geometry->scene->facts.materials.straight),
      raster_(*world.screen, *plan.asked.interpolation == Interpolation::perspective),
      point_paths_(std::make_unique<PathBatch<T>>()) {}

template <class T>
void ScanLine<T>::place(const TileView& tile, const TileSamples& samples) {
  tile_ = &tile;
  samples_ = &samples;
}

template <class T>
void ScanLine<T>::begin() {
  raster_.draw(*tile_, *samples_);
  layer_ = 0;
  if (shading_ != ShadingPoints::pixels) shade_points();
}

template <class T>
void ScanLine<T>::next_layer() {
  auto& v = *this->vertices_;
  PathBatch<T>& paths = *v.paths;
  layer_ = paths.depth;
  std::array<bool, kBatch> wanted{};
  for (int lane = 0; lane < paths.rays.count; ++lane)
    wanted[static_cast<std::size_t>(paths.slot[lane])] = true;
  raster_.peel(wanted);
  if (shading_ == ShadingPoints::pixels) return;
  shade_points();
  v.paths = &paths;
}

template <class T>
LaneGroups ScanLine<T>::find_vertices(const LaneGroups& groups) {
  auto& v = *this->vertices_;
  if (v.paths->depth != layer_) next_layer();
  const bool needs_surfaces = shading_ == ShadingPoints::pixels || !this->plan_.channels.empty() ||
                              this->atmosphere_ || has_straight_;
  reset(v.paths->rays, groups, v.hits);
  for (const int group : groups)
    for (int i = group; i < group + kWidth<T>; i += kLanes) {
      const Part part = part_at(i);
      if (part.empty) continue;
      Facets::Numbers triangles;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        triangles[lane] = raster_.triangle(part.slots[lane]);
        if (part.met[lane]) v.hits.primitive[i + static_cast<int>(lane)] = screen_.primitive(triangles[lane]);
      }
      if (needs_surfaces) put_surfaces(i, facets_of(triangles), raster_.weights(part.slots), part.met);
    }
  const LaneGroups met = start_surfaces(this->geometry_, groups, v.hits, v.surface, v.radiance);
  if (needs_surfaces) add_fields(this->geometry_, this->plan_.fields, *v.paths, met, v.hits, v.surface);
  return met;
}

template <class T>
void ScanLine<T>::shade_surfaces(const LaneGroups& met) {
  if (shading_ == ShadingPoints::pixels) return SpecularTree<T>::shade_surfaces(met);
  auto& v = *this->vertices_;
  for (const int group : met)
    for (int i = group; i < group + kWidth<T>; i += kLanes)
      if (const Part part = part_at(i); !part.empty) interpolate(i, part);
  if (!has_straight_) return;
  const LaneGroups straight = groups_with(this->geometry_, v.surface, met, &MaterialTraits::straight);
  evaluate_specular(this->geometry_, false, v.hits, v.surface, straight, *v.paths, this->specular_);
  for (const int i : straight) follow_straight(i);
}

template <class T>
void ScanLine<T>::interpolate(int i, const Part& part) {
  const bool constant = shading_ == ShadingPoints::triangles;
  const Facets::Weights weights = constant ? Facets::Weights() : raster_.weights(part.slots);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!part.met[lane]) continue;
    const Point* const points = &points_[static_cast<std::size_t>(point_of_[part.slots[lane]])];
    Vec3<T> radiance = points[0].radiance;
    if (!constant)
      radiance = points[0].radiance * static_cast<T>(weights.x[lane]) +
                 points[1].radiance * static_cast<T>(weights.y[lane]) +
                 points[2].radiance * static_cast<T>(weights.z[lane]);
    this->vertices_->radiance.set(i + static_cast<int>(lane), radiance);
  }
}

template <class T>
typename ScanLine<T>::Part ScanLine<T>::part_at(int i) const {
  const PathBatch<T>& paths = *this->vertices_->paths;
  Part part;
  int some = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const int ray = i + static_cast<int>(lane);
    if (!(paths.rays.t_max[ray] > 0) || !raster_.covered(slot_of(ray))) continue;
    part.met[lane] = true;
    part.slots[lane] = some = slot_of(ray);
    part.empty = false;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    if (!part.met[lane]) part.slots[lane] = some;
  return part;
}

template <class T>
void ScanLine<T>::scatter(const LaneGroups& groups) {
  const auto& specular = this->specular_;
  for (const int i : groups) {
    const auto straight = lanes_with(this->geometry_, this->vertices_->surface, i, &MaterialTraits::straight);
    const auto bent = this->specular_lanes(i) && !straight;
    for (const Vec3<N>& weight : {specular.reflectance.at(i), specular.transmittance.at(i)})
      this->add_ambient(i, bent, weight);
    if (shading_ == ShadingPoints::pixels) follow_straight(i);
  }
}

template <class T>
void ScanLine<T>::follow_straight(int i) {
  const auto straight = lanes_with(this->geometry_, this->vertices_->surface, i, &MaterialTraits::straight);
  this->follow(SpecularTree<T>::Kind::refracted, i, straight, this->specular_.refracted.at(i),
               this->specular_.transmittance.at(i));
}

template <class T>
void ScanLine<T>::shade_points() {
  visible_.clear();
  for (int slot = 0; slot < kBatch; ++slot)
    if (raster_.covered(slot))
      visible_.push_back(std::uint64_t{raster_.triangle(slot)} * kBatch + static_cast<unsigned>(slot));
  std::sort(visible_.begin(), visible_.end());
  points_.clear();
  std::int32_t first = 0;
  for (const std::uint64_t sample : visible_) {
    const auto triangle = static_cast<std::uint32_t>(sample / kBatch);
    if (points_.empty() || points_.back().triangle != triangle) {
      first = static_cast<std::int32_t>(points_.size());
      if (shading_ == ShadingPoints::triangles)
        points_.push_back({triangle, Vec3d(1.0 / 3), {}});
      else
        for (const Vec3d& corner : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
          points_.push_back({triangle, corner, {}});
    }
    point_of_[static_cast<int>(sample % kBatch)] = first;
  }
  for (std::size_t from = 0; from < points_.size(); from += kBatch)
    shade_batch(from, std::min(from + kBatch, points_.size()));
}

template <class T>
void ScanLine<T>::shade_batch(std::size_t first, std::size_t last) {
  auto& v = *this->vertices_;
  PathBatch<T>& paths = *point_paths_;
  v.paths = &paths;
  paths.rays.count = static_cast<int>(last - first);
  paths.seal();
  const LaneGroups groups = LaneGroups::covering(0, paths.rays.count, kWidth<T>);
  reset(paths.rays, groups, v.hits);
  const PixelFootprint pixel = pixel_footprint(this->plan_.frame, *this->plan_.camera, this->plan_.height);
  for (int i = 0; i < paths.rays.count; ++i) {
    paths.rays.t_max[i] = std::numeric_limits<T>::infinity();
    paths.throughput.set(i, Vec3<T>(T(1)));
    paths.slot[i] = 0;
    paths.width[i] = static_cast<T>(pixel.width);
    paths.spread[i] = static_cast<T>(pixel.spread);
  }
  for (int i = 0; i < paths.rays.count; i += kLanes) {
    Facets::Numbers triangles;
    std::array<const Point*, kLanes> points;
    std::array<bool, kLanes> met;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t point = first + static_cast<std::size_t>(i) + lane;
      met[lane] = point < last;
      points[lane] = &points_[std::min(point, last - 1)];
      triangles[lane] = points[lane]->triangle;
      if (met[lane]) v.hits.primitive[i + static_cast<int>(lane)] = screen_.primitive(triangles[lane]);
    }
    Facets::Weights weights;
    for (std::size_t k = 0; k < 3; ++k)
      weights[k] = Facets::N([&](auto lane) { return points[lane]->weights[k]; });
    const Facets facets = facets_of(triangles);
    put_rays(i, facets, weights);
    put_surfaces(i, facets, weights, met);
  }
  const LaneGroups met = start_surfaces(this->geometry_, groups, v.hits, v.surface, v.radiance);
  add_fields(this->geometry_, this->plan_.fields, paths, met, v.hits, v.surface);
  SpecularTree<T>::shade_surfaces(met);
  for (int i = 0; i < paths.rays.count; ++i)
    points_[first + static_cast<std::size_t>(i)].radiance = v.radiance[i];
}

template <class T>
void ScanLine<T>::put_surfaces(int i, const Facets& facets, const Facets::Weights& weights,
                               const std::array<bool, kLanes>& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  using D = Facets::N;
  const auto narrow = [](const Vec3<D>& v) { return convert_vector<Narrow>(v); };
  const Vec3<Narrow> at = narrow(facets.position(weights)),
                     direction = loaded<Narrow>(paths->rays.direction, i);
  store(i, surface.position, at);
  // Gouraud and Phong evaluate the interpolated normal only. The facing of the flat triangle has no effect,
  // unless the interpolated normal faces away from the viewer.
  const Vec3<D> seen = facets.normal(weights) * facets.side;
  const auto faces_viewer = dot(seen, convert_vector<D>(direction)) < D(0);
  store(i, surface.geometric, narrow(select(faces_viewer, seen, facets.face * facets.side)));
  store(i, surface.normal, narrow(seen));
  surface.side.put(i, stdx::static_simd_cast<Narrow>(facets.side));
  surface.step.put(i, Narrow(T(0)));  // no ray starts at the surface
  const Narrow t = dot(at - loaded<Narrow>(paths->rays.origin, i), direction);
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    if (met[lane]) hits.t[i + static_cast<int>(lane)] = t[lane];
}

template <class T>
void ScanLine<T>::put_rays(int i, const Facets& facets, const Facets::Weights& weights) {
  using D = Facets::N;
  const CameraFrame& frame = this->plan_.frame;
  const Vec3<D> eye(frame.eye), back(frame.back), from_eye = facets.position(weights) - eye;
  RayBatch<T>& rays = this->vertices_->paths->rays;
  store(i, rays.origin,
        convert_vector<Narrow>(screen_.parallel ? eye + from_eye + back * D(-dot(from_eye, back)) : eye));
  store(i, rays.direction, convert_vector<Narrow>(screen_.parallel ? -back : safe_normalize(from_eye)));
}

template class ScanLine<float>;
template class ScanLine<double>;

}  // namespace orrery
