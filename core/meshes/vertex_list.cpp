#include "core/meshes/vertex_list.h"

#include <bit>

namespace orrery {

std::uint32_t VertexList::add(const Vertex& vertex) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // maps -0 to 0
  const Vec3d &p = vertex.position, &n = vertex.normal, &c = vertex.color;
  const std::array words = {bits(p.x), bits(p.y), bits(p.z),          bits(n.x),
                            bits(n.y), bits(n.z), bits(vertex.uv[0]), bits(vertex.uv[1]),
                            bits(c.x), bits(c.y), bits(c.z)};
  const std::size_t used = with_colors_ ? words.size() : with_normals_ || with_uvs_ ? 8 : 3;
  const std::uint32_t hash = table_.hash(std::span(words).first(used));
  const std::size_t before = size();
  const std::uint32_t at = table_.find_or_add(hash, before, [&](std::uint32_t entry) {
    return mesh_.positions[entry] == p && (!with_normals_ || mesh_.normals[entry] == n) &&
           (!with_uvs_ || mesh_.uvs[entry] == vertex.uv) && (!with_colors_ || mesh_.colors[entry] == c);
  });
  if (at == before) {
    mesh_.positions.push_back(p);
    if (with_normals_) mesh_.normals.push_back(n);
    if (with_uvs_) mesh_.uvs.push_back(vertex.uv);
    if (with_colors_) mesh_.colors.push_back(c);
  }
  return at;
}

}  // namespace orrery
