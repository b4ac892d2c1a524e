#include "server/import/mesh_writer.h"

#include <bit>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

static_assert(std::endian::native == std::endian::little, "ply_of() copies the bytes of numbers");

template <class T>
void append_bytes(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

nlohmann::ordered_json triples(const std::vector<Vec3d>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Vec3d& v : values) list.push_back({v.x, v.y, v.z});
  return list;
}

}  // namespace

void add_mesh_keys(nlohmann::ordered_json& object, const TriangleMesh& mesh) {
  object["positions"] = triples(mesh.positions);
  object["indices"] = mesh.triangles;
  if (!mesh.normals.empty()) object["normals"] = triples(mesh.normals);
  if (!mesh.uvs.empty()) object["uvs"] = mesh.uvs;
}

std::string ply_of(const TriangleMesh& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(mesh.positions.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!mesh.normals.empty()) bytes += "property double nx\nproperty double ny\nproperty double nz\n";
  if (!mesh.uvs.empty()) bytes += "property double u\nproperty double v\n";
  bytes += "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    checkpoint(i);
    append_bytes(bytes, mesh.positions[i]);
    if (!mesh.normals.empty()) append_bytes(bytes, mesh.normals[i]);
    if (!mesh.uvs.empty()) append_bytes(bytes, mesh.uvs[i]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    checkpoint(i);
    bytes += '\3';
    append_bytes(bytes, mesh.triangles[i]);
  }
  return bytes;
}

}  // namespace orrery
