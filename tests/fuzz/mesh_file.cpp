#include <cmath>
#include <cstdlib>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"
#include "core/meshes/repair.h"

// Fuzzes the mesh reader. Any bytes are rejected or read as a mesh that satisfies the contract in the
// reader's header.

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const orrery::TriangleMesh& mesh, const orrery::MeshLimits& limits) {
  require(!mesh.triangles.empty() && mesh.triangles.size() <= limits.triangles);
  require(mesh.positions.size() <= limits.vertices);
  require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) require(i < mesh.positions.size());
  for (const auto& p : mesh.positions) require(std::isfinite(p.x + 0 * p.y + 0 * p.z));
  for (const auto& n : mesh.normals) require(std::abs(length(n) - 1) < 1e-14);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const orrery::MeshLimits limits{100'000, 100'000};
  try {
    orrery::TriangleMesh mesh =
        orrery::read_mesh(std::string_view(reinterpret_cast<const char*>(data), size), limits);
    check(mesh, limits);
    orrery::drop_degenerate(mesh);
    if (mesh.triangles.empty()) return 0;
    const orrery::PositionIndices places = orrery::position_indices_of(mesh.positions);
    if (orrery::count_pairs(mesh, places) < 1'000'000) orrery::smooth_normals(mesh, 40, places);
    mesh.positions.size() <= limits.vertices ? check(mesh, limits) : void();
  } catch (const orrery::InputError& error) {
    require(std::string_view(error.what()).size() < 500);
  }
  return 0;
}
