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

// Groups the edges by their lower position with a counting sort. A group has about six edges.
bool is_watertight(std::span<const std::array<std::uint32_t, 3>> triangles, const PositionIndices& places) {
  struct Edge {
    std::uint32_t high;
    std::int32_t direction;  // 1: from low to high
  };
  const auto for_each_edge = [&](const auto& visit) {
    for (const auto& triangle : triangles) {
      checkpoint();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = places[triangle[k]], to = places[triangle[(k + 1) % 3]];
        if (from != to) visit(std::min(from, to), Edge{std::max(from, to), from < to ? 1 : -1});
      }
    }
  };
  std::vector<std::size_t> end(places.size() + 1, 0);  // by lower position; first the begin of its group
  for_each_edge([&](std::uint32_t low, const Edge&) { ++end[low + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<Edge> edges(end.back());
  for_each_edge([&](std::uint32_t low, const Edge& edge) { edges[end[low]++] = edge; });
  auto first = edges.begin();
  for (std::size_t low = 0; low < places.size(); ++low) {
    checkpoint(low);
    const auto last = edges.begin() + static_cast<std::ptrdiff_t>(end[low]);
    std::sort(first, last, [](const Edge& a, const Edge& b) { return a.high < b.high; });
    std::int64_t sum = 0;
    for (; first != last; ++first) {
      sum += first->direction;
      const bool ends = first + 1 == last || first[1].high != first->high;
      if (ends && sum != 0) return false;
    }
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
