#include "core/raster/facets.h"

#include "core/math/face_normal.h"

namespace orrery {

Facets::Facets(const Screen& screen, const CameraFrame& frame, const Numbers& triangles, bool smooth) {
  std::array<std::array<const Tessellation::Vertex*, kLanes>, 3> corners;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto& vertices = screen.surfaces.triangles[triangles[lane]].vertices;
    for (std::size_t k = 0; k < 3; ++k) corners[k][lane] = &screen.surfaces.vertices[vertices[k]];
  }
  const auto gathered = [&](std::size_t k, Vec3d Tessellation::Vertex::*member) {
    const auto& from = corners[k];
    return Vec3<N>(N([&](auto lane) { return (from[lane]->*member).x; }),
                   N([&](auto lane) { return (from[lane]->*member).y; }),
                   N([&](auto lane) { return (from[lane]->*member).z; }));
  };
  const N zero(0);
  N::mask_type is_smooth(smooth);
  for (std::size_t k = 0; k < 3; ++k) {
    positions[k] = gathered(k, &Tessellation::Vertex::position);
    if (!smooth) continue;
    normals[k] = gathered(k, &Tessellation::Vertex::normal);
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
