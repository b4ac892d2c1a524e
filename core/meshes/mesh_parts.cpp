#include "core/meshes/mesh_parts.h"

#include <algorithm>

namespace orrery {

void start_part(std::size_t first, std::int32_t material, std::vector<MeshPart>& parts) {
  if (!parts.empty() && parts.back().material == material) return;
  parts.push_back({static_cast<std::uint32_t>(first), material});
}

void group_parts(TriangleMesh& mesh) {
  std::int32_t most = -1;
  for (const MeshPart& part : mesh.parts) most = std::max(most, part.material);
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> slot_of(static_cast<std::size_t>(most) + 2, kNone);  // by material + 1
  std::vector<MeshPart> grouped_parts;
  std::vector<std::uint32_t> counts;
  const auto size_of_part = [&](std::size_t i) {
    return static_cast<std::uint32_t>(i + 1 < mesh.parts.size() ? mesh.parts[i + 1].first_triangle
                                                                : mesh.triangles.size()) -
           mesh.parts[i].first_triangle;
  };
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    checkpoint(i);
    if (size_of_part(i) == 0) continue;
    std::uint32_t& slot = slot_of[static_cast<std::size_t>(mesh.parts[i].material + 1)];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(counts.size());
      grouped_parts.push_back({0, mesh.parts[i].material});
      counts.push_back(0);
    }
    counts[slot] += size_of_part(i);
  }
  std::vector<std::uint32_t> next(counts.size());
  for (std::size_t slot = 1; slot < counts.size(); ++slot)
    grouped_parts[slot].first_triangle = next[slot] = next[slot - 1] + counts[slot - 1];
  std::vector<std::array<std::uint32_t, 3>> triangles(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    checkpoint();
    const std::uint32_t size = size_of_part(i);
    if (size == 0) continue;
    std::uint32_t& to = next[slot_of[static_cast<std::size_t>(mesh.parts[i].material + 1)]];
    std::copy_n(mesh.triangles.begin() + mesh.parts[i].first_triangle, size, triangles.begin() + to);
    to += size;
  }
  mesh.triangles = std::move(triangles);
  mesh.parts = std::move(grouped_parts);
}

}  // namespace orrery
