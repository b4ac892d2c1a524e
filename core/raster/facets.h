#pragma once

#include "core/raster/screen.h"

namespace orrery {

// Triangles in lanes, one per lane, with data that all points of a triangle share.
struct Facets {
  using N = Lanes<double>;
  static constexpr int kLanes = kWidth<double>;
  using Numbers = std::array<std::uint32_t, kLanes>;  // see Screen::Block
  using Weights = Vec3<N>;                            // one for each corner of a triangle

  std::array<Vec3<N>, 3> positions, normals;
  Vec3<N> face;  // outward unit normal of the triangle
  N side;        // SurfaceBatch::side

  // `smooth`: uses the normals of vertices that have them.
  Facets(const Screen& screen, const CameraFrame& frame, const Numbers& triangles, bool smooth);

  Vec3<N> position(const Weights& weights) const { return mix(positions, weights); }
  // Returns the interpolated unit normal, outward.
  Vec3<N> normal(const Weights& weights) const;

 private:
  static Vec3<N> mix(const std::array<Vec3<N>, 3>& at, const Weights& weights) {
    return at[0] * weights.x + at[1] * weights.y + at[2] * weights.z;
  }
};

}  // namespace orrery
