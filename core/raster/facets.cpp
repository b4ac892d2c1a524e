#include "core/raster/facets.h"

#include "core/math/face_normal.h"

namespace orrery {

Facets::Facets(const Screen& screen, const CameraFrame& frame, const Numbers& triangles, bool smooth) {
  std::array<std::array<const Vec3d*, kLanes>, 3> position_of, normal_of;
  static constexpr Vec3d kNone;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Screen::Block& block = screen.block_of(triangles[lane]);
    const auto& corners = block.corners[triangles[lane] - block.first];
    for (std::size_t k = 0; k < 3; ++k) {
      position_of[k][lane] = &block.positions[corners[k]];
      normal_of[k][lane] = block.normals.first ? &block.normals[corners[k]] : &kNone;
    }
  }
  const auto gathered = [](const std::array<const Vec3d*, kLanes>& from) {
    return Vec3<N>(N([&](auto lane) { return from[lane]->x; }), N([&](auto lane) { return from[lane]->y; }),
                   N([&](auto lane) { return from[lane]->z; }));
  };
  const N zero(0);
  N::mask_type is_smooth(smooth);
  for (std::size_t k = 0; k < 3; ++k) {
    positions[k] = gathered(position_of[k]);
    if (!smooth) continue;
    normals[k] = gathered(normal_of[k]);
    is_smooth = is_smooth && (normals[k].x != zero || normals[k].y != zero || normals[k].z != zero);
  }
  const auto& [a, b, c] = positions;
  face = all(is_smooth) ? safe_normalize(cross(b - a, c - a)) : face_normal(a, b, c);
  if (!all(is_smooth)) {
    if (any(is_smooth)) face = select(is_smooth, safe_normalize(cross(b - a, c - a)), face);
    for (Vec3<N>& normal : normals) normal = select(is_smooth, normal, face);
  }
  const Vec3<N> toward = screen.parallel ? Vec3<N>(-frame.back) : a - Vec3<N>(frame.eye);
  side = select(dot(face, toward) > zero, N(-1), N(1));
}

Vec3<Facets::N> Facets::normal(const Weights& weights) const {
  const Vec3<N> sum = mix(normals, weights);
  const N size = length(sum);
  return select(size > N(0.001), sum / size, face);  // otherwise the normals nearly cancel
}

}  // namespace orrery
