#include <cmath>

#include "core/shapes/triangle_hit.h"
#include "core/stability/ball_mesh.h"
#include "core/stability/moller_trumbore.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Measures the percentage of about 10,000 rays that leave the closed mesh between its triangles.
StabilityFigures measure() {
  constexpr int kRaysAtEach = 9;  // rays toward each of the 1106 vertices
  const BallMesh mesh(2, Vec3d());
  SplitMix random(7);
  int rays = 0, known = 0, ours = 0;
  for (int vertex = 0; vertex < static_cast<int>(mesh.positions.size()); ++vertex) {
    const std::vector<int> fan = mesh.around(vertex);
    for (int i = 0; i < kRaysAtEach; ++i, ++rays) {
      const Ray<double> ray = mesh.ray_at<double>(vertex, fan, Vec3d(), random);
      bool known_met = false, met = false;
      for (const int number : fan) {
        const auto& corners = mesh.triangles[static_cast<std::size_t>(number)];
        const auto at = [&](std::size_t corner) {
          return mesh.positions[static_cast<std::size_t>(corners[corner])];
        };
        const Vec3d a = at(0), b = at(1), c = at(2);
        known_met = known_met || std::isfinite(moller_trumbore(ray, a, b, c, 0.0));
        met = met || std::isfinite(Corners<double>{a, b, c}.distance(ray));
      }
      known += !known_met;
      ours += !met;
    }
  }
  return {100.0 * known / rays, 100.0 * ours / rays};
}

}  // namespace

StabilityRow watertight_edges_row() {
  return {
      "A12",
      "Edges of a closed mesh",
      "rays from inside a ball of 2,208 triangles toward its vertices and edge midpoints, in double: rays "
      "that leak out",
      "%",
      "barycentric coordinates of each triangle separately (Moeller, Trumbore 1997)",
      5,
      "signs of edge functions that adjacent triangles share (Woop, Benthin, Wald 2013)",
      0,
      measure};
}

}  // namespace orrery
