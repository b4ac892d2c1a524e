#include "core/techniques/scan_line.h"

#include <algorithm>

#include "core/lighting/specular.h"
#include "core/lighting/surfaces.h"
#include "core/math/face_normal.h"

namespace orrery {

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
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      const int slot = slot_of(lane);
      if (!(v.paths->rays.t_max[lane] > 0) || !raster_.covered(slot)) continue;
      use_facet(raster_.triangle(slot));
      v.hits.primitive[lane] = facet_.primitive;
      if (needs_surfaces) put_surface(lane, raster_.weights(slot), v.paths->rays[lane]);
    }
  const LaneGroups met = start_surfaces(this->geometry_, groups, v.hits, v.surface, v.radiance);
  if (needs_surfaces) add_fields(this->geometry_, this->plan_.fields, *v.paths, met, v.hits, v.surface);
  return met;
}

template <class T>
void ScanLine<T>::shade_surfaces(const LaneGroups& met) {
  if (shading_ == ShadingPoints::pixels) return SpecularTree<T>::shade_surfaces(met);
  auto& v = *this->vertices_;
  for (const int i : met)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      if (v.hits.primitive[lane] == kNoPrimitive) continue;
      const int slot = slot_of(lane);
      const Point* const points = &points_[static_cast<std::size_t>(point_of_[slot])];
      if (shading_ == ShadingPoints::triangles) {
        v.radiance.set(lane, points[0].radiance);
      } else {
        const Vec3<T> weights(raster_.weights(slot));
        v.radiance.set(lane, points[0].radiance * weights.x + points[1].radiance * weights.y +
                                 points[2].radiance * weights.z);
      }
    }
  if (!has_straight_) return;
  const LaneGroups straight = groups_with(this->geometry_, v.surface, met, &MaterialTraits::straight);
  evaluate_specular(this->geometry_, false, v.hits, v.surface, straight, *v.paths, this->specular_);
  for (const int i : straight) follow_straight(i);
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
        points_.push_back({triangle, Weights(1.0 / 3), {}});
      else
        for (const Weights& corner : {Weights(1, 0, 0), Weights(0, 1, 0), Weights(0, 0, 1)})
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
    const Point& point = points_[first + static_cast<std::size_t>(i)];
    use_facet(point.triangle);
    const Ray<T> ray = ray_to(point.weights);
    paths.rays.set(i, ray, std::numeric_limits<T>::infinity());
    paths.throughput.set(i, Vec3<T>(T(1)));
    paths.slot[i] = 0;
    paths.width[i] = static_cast<T>(pixel.width);
    paths.spread[i] = static_cast<T>(pixel.spread);
    put_surface(i, point.weights, ray);
  }
  const LaneGroups met = start_surfaces(this->geometry_, groups, v.hits, v.surface, v.radiance);
  add_fields(this->geometry_, this->plan_.fields, paths, met, v.hits, v.surface);
  SpecularTree<T>::shade_surfaces(met);
  for (int i = 0; i < paths.rays.count; ++i)
    points_[first + static_cast<std::size_t>(i)].radiance = v.radiance[i];
}

template <class T>
void ScanLine<T>::use_facet(std::uint32_t number) {
  if (facet_.triangle == number) return;
  const Tessellation& surfaces = screen_.surfaces;
  const Tessellation::Triangle& triangle = surfaces.triangles[number];
  facet_.triangle = number;
  facet_.primitive = triangle.primitive;
  for (std::size_t k = 0; k < 3; ++k) facet_.positions[k] = surfaces.vertices[triangle.vertices[k]].position;
  const auto& [a, b, c] = facet_.positions;
  bool smooth = shading_ != ShadingPoints::triangles;
  for (std::size_t k = 0; k < 3; ++k) {
    facet_.normals[k] = surfaces.vertices[triangle.vertices[k]].normal;
    smooth = smooth && facet_.normals[k] != Vec3d();
  }
  facet_.face = smooth ? safe_normalize(cross(b - a, c - a)) : face_normal(a, b, c);
  if (!smooth) facet_.normals.fill(facet_.face);
  const CameraFrame& frame = this->plan_.frame;
  facet_.side = dot(facet_.face, screen_.parallel ? -frame.back : a - frame.eye) > 0 ? -1 : 1;
}

template <class T>
void ScanLine<T>::put_surface(int i, const Weights& weights, const Ray<T>& ray) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  const auto mix = [&](const std::array<Vec3d, 3>& at) {
    return at[0] * weights.x + at[1] * weights.y + at[2] * weights.z;
  };
  const Vec3d sum = mix(facet_.normals);
  const double size = length(sum);
  const Vec3d normal = size > 0.001 ? sum / size : facet_.face;  // otherwise the normals nearly cancel
  const Vec3<T> at(mix(facet_.positions));
  surface.position.set(i, at);
  // Gouraud and Phong evaluate the interpolated normal only. The facing of the flat triangle has no effect,
  // unless the interpolated normal faces away from the viewer.
  const Vec3d seen = normal * facet_.side;
  const bool faces_viewer = dot(seen, Vec3d(ray.direction)) < 0;
  surface.geometric.set(i, Vec3<T>(faces_viewer ? seen : facet_.face * facet_.side));
  surface.normal.set(i, Vec3<T>(seen));
  surface.side[i] = static_cast<T>(facet_.side);
  surface.step[i] = 0;  // no ray starts at the surface
  hits.t[i] = dot(at - ray.origin, ray.direction);
  hits.primitive[i] = facet_.primitive;
}

template <class T>
Ray<T> ScanLine<T>::ray_to(const Weights& weights) const {
  const CameraFrame& frame = this->plan_.frame;
  const auto& [a, b, c] = facet_.positions;
  const Vec3d from_eye = a * weights.x + b * weights.y + c * weights.z - frame.eye;
  if (!screen_.parallel) return {Vec3<T>(frame.eye), Vec3<T>(safe_normalize(from_eye))};
  return {Vec3<T>(frame.eye + from_eye + frame.back * -dot(from_eye, frame.back)), Vec3<T>(-frame.back)};
}

template class ScanLine<float>;
template class ScanLine<double>;

}  // namespace orrery
