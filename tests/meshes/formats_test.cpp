#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;

struct File {
  const char* name;
  MeshFormat format;
  std::string bytes;
};
std::vector<File> cubes() {
  const TriangleMesh mesh = cube();
  return {{"obj", MeshFormat::obj, obj_of(mesh)},
          {"ply ascii", MeshFormat::ply, ply_of(mesh)},
          {"ply little", MeshFormat::ply, ply_of(mesh, std::endian::little)},
          {"ply big", MeshFormat::ply, ply_of(mesh, std::endian::big)},
          {"stl ascii", MeshFormat::stl, ascii_stl_of(mesh)},
          {"stl binary", MeshFormat::stl, binary_stl_of(mesh)},
          {"gltf", MeshFormat::gltf, gltf_of(mesh).gltf(kOneMesh)},
          {"glb", MeshFormat::gltf, gltf_of(mesh).glb(kOneMesh)},
          {"3mf", MeshFormat::three_mf, three_mf_of(mesh)}};
}

TEST(MeshFile, ReadsSameCubeFromEveryFormat) {
  for (const File& file : cubes()) {
    SCOPED_TRACE(file.name);
    EXPECT_EQ(mesh_format(file.bytes), file.format);
    const TriangleMesh mesh = read_mesh(file.bytes);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(corners_of(mesh), corners_of(cube()));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
  }
}

TEST(MeshFile, IsDeterministic) {
  for (const File& file : cubes()) {
    const TriangleMesh a = read_mesh(file.bytes), b = read_mesh(file.bytes);
    EXPECT_EQ(a.positions, b.positions) << file.name;
    EXPECT_EQ(a.triangles, b.triangles) << file.name;
  }
}

TEST(MeshFile, AppliesLimitsInEveryFormat) {
  for (const File& file : cubes()) {
    EXPECT_EQ(problem(file.bytes, {8, 12}), "accepted") << file.name;
    EXPECT_THAT(problem(file.bytes, {7, 12}), HasSubstr("vertices (limit 7, mesh_vertices)")) << file.name;
    EXPECT_THAT(problem(file.bytes, {8, 11}), HasSubstr("triangles (limit 11, mesh_triangles)")) << file.name;
  }
}

TEST(MeshFile, RejectsTruncatedFilesOrReadsThemUpToCut) {
  const std::vector<Corners> whole = corners_of(cube());
  for (const File& file : cubes())
    for (std::size_t size = 0; size < file.bytes.size(); ++size) {
      // Allocation of exact size, so that sanitizers report overreads.
      const std::string bytes = file.bytes.substr(0, size);
      if (problem(bytes) != "accepted") continue;
      const std::vector<Corners> read = corners_of(read_mesh(bytes));
      EXPECT_TRUE(file.format == MeshFormat::obj || read.size() == whole.size()) << file.name << size;
      EXPECT_TRUE(std::equal(read.begin(), read.end(), whole.begin())) << file.name << size;
    }
}

TEST(MeshFile, ReportsFirstBytesOfUnknownFiles) {
  EXPECT_THAT(problem(""), HasSubstr("0 bytes that begin with \"\""));
  EXPECT_THAT(problem("GIF89a\x01\x02"), HasSubstr("begin with \"GIF89a??\""));
  EXPECT_THAT(problem(std::string(500, 'x')), HasSubstr(std::string(40, 'x') + "...\""));
  EXPECT_THAT(problem("# only a comment\n"), HasSubstr("must be an OBJ, PLY, STL"));
  const std::string stl = binary_stl_of(cube(), "");
  EXPECT_THAT(problem(stl.substr(0, stl.size() - 1)), HasSubstr("STL (84 + 50 n bytes if binary)"));
}

TEST(MeshFile, RejectsMeshWithoutTriangles) {
  EXPECT_THAT(problem("v 0 0 0\n"), HasSubstr("at least 1 triangle"));
  EXPECT_THAT(problem("solid\nendsolid\n"), HasSubstr("at least 1 triangle"));
  EXPECT_THAT(problem(ply_header("ascii", 0, 0)), HasSubstr("at least 1 triangle"));
  EXPECT_THAT(problem(R"({"asset":{"version":"2.0"},"nodes":[{}]})"), HasSubstr("at least 1 triangle"));
}

}  // namespace
}  // namespace orrery::test
