#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/math/elementary.h"
#include "core/model/batch.h"
#include "core/stability/split_mix.h"

namespace orrery {

// Closed mesh of a sphere with 24 rings of 48 sectors: 1,106 vertices and 2,208 triangles.
struct BallMesh {
  static constexpr int kRings = 24, kSectors = 48;
  std::vector<Vec3d> positions;
  std::vector<std::array<int, 3>> triangles;

  BallMesh(double radius, const Vec3d& center) {
    positions.push_back(center + Vec3d(0, 0, radius));
    for (int ring = 1; ring < kRings; ++ring)
      for (int sector = 0; sector < kSectors; ++sector) {
        const auto theta = sine_cosine_turns(0.5 * ring / kRings),
                   phi = sine_cosine_turns(1.0 * sector / kSectors);
        positions.push_back(center +
                            Vec3d(theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine) * radius);
      }
    positions.push_back(center - Vec3d(0, 0, radius));
    const int last = static_cast<int>(positions.size()) - 1;
    const auto at = [](int ring, int sector) { return 1 + (ring - 1) * kSectors + sector % kSectors; };
    for (int sector = 0; sector < kSectors; ++sector) {
      triangles.push_back({0, at(1, sector), at(1, sector + 1)});
      triangles.push_back({last, at(kRings - 1, sector + 1), at(kRings - 1, sector)});
      for (int ring = 1; ring + 1 < kRings; ++ring) {
        triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
        triangles.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
      }
    }
  }

  // Returns the indices of the triangles with this vertex.
  std::vector<int> around(int vertex) const {
    std::vector<int> found;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (std::find(triangles[t].begin(), triangles[t].end(), vertex) != triangles[t].end())
        found.push_back(static_cast<int>(t));
    return found;
  }

  // Returns a ray with coordinates rounded to T. The origin is random, at most 1 m from `center`. The target
  // is `vertex` or the midpoint of an edge at `vertex`, so the ray must hit a triangle of `fan`. REQUIRES:
  // `fan` is around(vertex).
  template <class T>
  Ray<T> ray_at(int vertex, const std::vector<int>& fan, const Vec3d& center, SplitMix& random) const {
    const auto& triangle = triangles[static_cast<std::size_t>(
        fan[static_cast<std::size_t>(random.below(static_cast<int>(fan.size())))])];
    const int other = triangle[static_cast<std::size_t>(random.below(3))];  // may be `vertex` itself
    const Vec3<T> a(positions[static_cast<std::size_t>(vertex)]),
        b(positions[static_cast<std::size_t>(other)]);
    const Vec3<T> origin(center + random.in_cube(0.57));
    return {origin, (a + b) * T(0.5) - origin};
  }
};

}  // namespace orrery
