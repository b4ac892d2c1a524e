#include "core/meshes/repair.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/math/face_normal.h"

namespace orrery {

std::size_t drop_degenerate(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const auto& t) {
    checkpoint();
    const Vec3d &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    return face_normal(a, b, c) == Vec3d();
  });
}

bool is_watertight(std::span<const std::array<std::uint32_t, 3>> triangles, const PositionIndices& places) {
  struct Edge {
    std::uint32_t low, high;
    int direction;  // 1: from low to high
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    checkpoint();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = places[triangle[k]], to = places[triangle[(k + 1) % 3]];
      if (from != to) edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  const auto before = [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  };
  std::sort(edges.begin(), edges.end(), before);
  int sum = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    checkpoint(i);
    sum += edges[i].direction;
    if (i + 1 < edges.size() && !before(edges[i], edges[i + 1])) continue;
    if (sum != 0) return false;
  }
  return !edges.empty();
}

void drop_unused(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) place[vertex] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    checkpoint(v);
    if (place[v] == kUnused) continue;
    place[v] = kept;
    mesh.positions[kept] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[v];
    if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[v];
    ++kept;
  }
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  if (!mesh.colors.empty()) mesh.colors.resize(kept);
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = place[vertex];
}

}  // namespace orrery
