#include "core/shapes/moving_mesh.h"

namespace orrery {
namespace {

// Returns mix_one(before, after) for each pair of vectors, or `before` itself if both keys share one list.
template <class Mix>
SharedVectors mixed(const SharedVectors& before, const SharedVectors& after, const Mix& mix_one) {
  if (before == after) return before;
  auto vectors = std::make_shared<std::vector<Vec3d>>();
  vectors->reserve(before->size());
  for (std::size_t v = 0; v < before->size(); ++v) vectors->push_back(mix_one((*before)[v], (*after)[v]));
  return vectors;
}

}  // namespace

VertexKey mix(const VertexKey& before, const VertexKey& after, double share) {
  const auto straight = [&](const Vec3d& a, const Vec3d& b) { return a * (1 - share) + b * share; };
  return {mixed(before.positions, after.positions, straight),
          mixed(before.normals, after.normals, [&](const Vec3d& a, const Vec3d& b) {
            const Vec3d normal = safe_normalize(straight(a, b));
            return normal == Vec3d() ? a : normal;
          })};
}

TriangleMesh MovingMesh::at(double time) const {
  const VertexKey vertices = keys.at(time);
  TriangleMesh mesh{*vertices.positions, triangles, *vertices.normals, uvs};
  if (crease_degrees) {
    const PositionIndices now = position_indices_of(mesh.positions);
    smooth_normals(mesh, *crease_degrees, count_pairs(mesh, now) <= max_pairs ? now : always);
  }
  return mesh;
}

std::vector<Vec3d> MovingMesh::corner_normals(double time) const {
  const auto of_corners = [](const auto& corners, const std::vector<Vec3d>& normals) {
    std::vector<Vec3d> all;
    if (normals.empty()) return all;
    all.reserve(3 * corners.size());
    for (const auto& triangle : corners)
      for (const std::uint32_t vertex : triangle) all.push_back(normals[vertex]);
    return all;
  };
  if (crease_degrees) {
    const TriangleMesh mesh = at(time);
    return of_corners(mesh.triangles, mesh.normals);
  }
  const auto straight = [](const Vec3d& a, const Vec3d& b, double share) {
    return a * (1 - share) + b * share;
  };
  return of_corners(triangles, *keys.between(time,
                                             [&](const VertexKey& a, const VertexKey& b, double share) {
                                               return VertexKey{a.positions,
                                                                mixed(a.normals, b.normals,
                                                                      [&](const Vec3d& x, const Vec3d& y) {
                                                                        return straight(x, y, share);
                                                                      })};
                                             })
                                    .normals);
}

}  // namespace orrery
