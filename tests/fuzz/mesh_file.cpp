#include "core/meshes/mesh_file.h"

#include "core/base/error.h"
#include "core/meshes/model.h"
#include "core/meshes/repair.h"
#include "tests/fuzz/model_check.h"

// Fuzzes the mesh reader. Any bytes are rejected or read as a mesh that satisfies the contract in the
// reader's header.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace orrery;
  const MeshLimits limits{100'000, 100'000};
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    test::check_model(read_model(bytes, limits, {}, {.pose = ModelPose{0, 0.5}}), limits);
  } catch (const InputError&) {  // most files have no animation
  }
  try {
    const MeshModel model = read_model(bytes, limits);
    test::check_model(model, limits);
    TriangleMesh mesh = whole_of(model.mesh);
    drop_degenerate(mesh);
    if (mesh.triangles.empty()) return 0;
    const PositionIndices places = position_indices_of(mesh.positions);
    if (count_pairs(mesh, places) < 1'000'000) smooth_normals(mesh, 40, places);
    if (mesh.positions.size() <= limits.vertices) test::check_mesh(mesh, limits);
  } catch (const InputError& error) {
    test::require(std::string_view(error.what()).size() < 500);
  }
  return 0;
}
