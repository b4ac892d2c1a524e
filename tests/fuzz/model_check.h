#pragma once

#include <cmath>
#include <cstdlib>

#include "core/meshes/model.h"

namespace orrery::test {

inline void require(bool holds) {
  if (!holds) std::abort();
}

// Aborts unless the mesh satisfies the contract of read_mesh() or read_model().
inline void check_mesh(const TriangleMesh& mesh, const MeshLimits& limits) {
  require(!mesh.triangles.empty() && mesh.triangles.size() <= limits.triangles);
  require(mesh.positions.size() <= limits.vertices);
  require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) require(i < mesh.positions.size());
  for (const auto& p : mesh.positions) require(std::isfinite(p.x + 0 * p.y + 0 * p.z));
  for (const auto& n : mesh.normals) require(std::abs(length(n) - 1) < 1e-14);
  const auto in_range = [](double x) { return x >= 0 && x <= 1; };
  for (const auto& c : mesh.colors) require(in_range(c.x) && in_range(c.y) && in_range(c.z));
}

// Aborts unless the parts and materials of the model satisfy the contract of read_model().
inline void check_model(const MeshModel& model, const MeshLimits& limits) {
  check_mesh(model.mesh, limits);
  const std::vector<MeshPart>& parts = model.mesh.parts;
  require(parts.empty() || parts[0].first_triangle == 0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    require(i == 0 || parts[i].first_triangle >= parts[i - 1].first_triangle);
    require(parts[i].first_triangle <= model.mesh.triangles.size());
    require(parts[i].material >= -1 && parts[i].material < static_cast<std::int64_t>(model.materials.size()));
    require(!parts[i].has_normals || !model.mesh.normals.empty());
    require(!parts[i].has_uvs || !model.mesh.uvs.empty());
    require(!parts[i].has_colors || !model.mesh.colors.empty());
  }
  const auto check_image = [&](const std::optional<ModelTexture>& texture) {
    require(!texture || (texture->image >= 0 && texture->image < static_cast<int>(model.images.size())));
  };
  for (const ModelMaterial& material : model.materials) {
    require(material.opacity >= 0 && material.opacity <= 1);
    require(material.roughness.factor >= 0 && material.roughness.factor <= 1);
    check_image(material.base_color.texture);
    check_image(material.emission.texture);
    check_image(material.roughness.texture);
    if (material.normal) check_image(material.normal->texture);
  }
  for (const int material : materials_in_use(model.mesh)) {
    const TriangleMesh part = part_of(model.mesh, material);
    if (!part.triangles.empty()) check_mesh(part, limits);
  }
}

}  // namespace orrery::test
