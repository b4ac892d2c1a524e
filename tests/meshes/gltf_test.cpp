#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;
using Triangle = std::array<std::uint32_t, 3>;

const std::vector<Vec3d> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

// Returns the mesh of a document with kTriangle as mesh 0 and the members in `nodes`.
TriangleMesh placed(const std::string& nodes) {
  Gltf gltf;
  gltf.positions(kTriangle);
  gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
  return read_mesh(
      gltf.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}],)" + nodes));
}
// Returns the members of a document with one mesh, whose positions are accessor `positions`.
std::string one_mesh_of(const std::string& positions) {
  return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" + positions + "}}]}]";
}
void expect_near(const Vec3d& a, const Vec3d& b, double bound = 1e-15) {
  EXPECT_LE(length(a - b), bound) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Gltf, ReadsTrianglesStripsAndFans) {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}});
  const auto triangles = [&](const std::string& mode) {
    return read_mesh(
               gltf.glb(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" +
                        mode + "}]}]"))
        .triangles;
  };
  EXPECT_EQ(triangles(""), (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(triangles(",\"mode\":4"), (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(triangles(",\"mode\":5"), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}));
  EXPECT_EQ(triangles(",\"mode\":6"), (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}}));
}

TEST(Gltf, ReadsIndicesOfEveryWidth) {
  Gltf gltf;
  gltf.positions(kTriangle);
  gltf.add<std::uint8_t>({2, 0, 1}, "SCALAR", 5121);
  gltf.add<std::uint16_t>({2, 0, 1}, "SCALAR", 5123);
  gltf.add<std::uint32_t>({2, 0, 1}, "SCALAR", 5125);
  for (const char* indices : {"1", "2", "3"})
    EXPECT_EQ(read_mesh(gltf.gltf(std::string(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)") +
                                  R"({"attributes":{"POSITION":0},"indices":)" + indices + "}]}]"))
                  .triangles,
              (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(Gltf, ReadsMatricesInColumnOrder) {
  const TriangleMesh mesh = placed(R"("nodes":[{"mesh":0,"matrix":[0,2,0,0,-3,0,0,0,0,0,4,0,5,6,7,1]}])");
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{5, 6, 7}, {5, 8, 7}, {2, 6, 7}}));
  EXPECT_EQ(mesh.normals[0], Vec3d(0, 0, 1));
}

// The mesh is scaled, turned by 90 degrees about y and moved. Its parent is turned by 90 degrees about z.
TEST(Gltf, ComposesNestedTransforms) {
  const std::string half = number(std::sqrt(0.5));
  const TriangleMesh mesh = placed(
      "\"nodes\":[{\"mesh\":0,\"scale\":[2,3,4],\"rotation\":[0," + half + ",0," + half +
      "],\"translation\":[10,20,30]},{\"children\":[0],\"rotation\":[0,0," + half + "," + half + "]}]");
  // (x, y, z) -> (2x, 3y, 4z) -> (4z, 3y, -2x) -> + (10, 20, 30) -> (-y, x, z)
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d p = kTriangle[i];
    expect_near(mesh.positions[i], {-(3 * p.y + 20), 4 * p.z + 10, -2 * p.x + 30}, 1e-14);
    expect_near(mesh.normals[i], {0, 1, 0});
  }
}

// Under (x, y, z) -> (x, y, z + 2 x), the plane z = 0 becomes z = 2 x.
TEST(Gltf, KeepsNormalsPerpendicularUnderShear) {
  const TriangleMesh mesh = placed(R"("nodes":[{"mesh":0,"matrix":[1,0,2,0,0,1,0,0,0,0,1,0,0,0,0,1]}])");
  expect_near(mesh.normals[0], Vec3d(-2, 0, 1) / std::sqrt(5.0));
  const Vec3d flat =
      normalize(cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]));
  expect_near(mesh.normals[0], flat);
}

TEST(Gltf, KeepsFrontFacesOutsideIfMirrored) {
  for (const char* scale : {"[-1,1,1]", "[1,-2,1]", "[-1,-1,-3]", "[-1,-1,1]", "[1e-200,1e-200,-1e-200]"}) {
    Gltf gltf = gltf_of(cube());
    std::vector<float> outward;
    for (const Vec3d& p : cube().positions)
      for (const double x : {p.x, p.y, p.z}) outward.push_back(static_cast<float>(x));
    gltf.add(outward, "VEC3", 5126);
    const TriangleMesh mesh = read_mesh(
        gltf.glb(std::string(R"("nodes":[{"mesh":0,"scale":)") + scale +
                 R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":2},"indices":1}]}])"));
    for (const Corners& c : corners_of(mesh)) {
      const Vec3d a = safe_normalize(c[1] - c[0]), b = safe_normalize(c[2] - c[0]);
      EXPECT_GT(dot(cross(a, b), safe_normalize(c[0])), 0) << scale;
    }
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_GT(dot(mesh.normals[i], safe_normalize(mesh.positions[i])), 0) << scale;
  }
}

TEST(Gltf, ReadsOnlyNodesOfScene) {
  const std::string nodes = R"("nodes":[{"mesh":0},{"mesh":0,"translation":[1,0,0]},{"children":[1]}])";
  EXPECT_EQ(placed(nodes).triangles.size(), 2u);  // roots 0 and 2
  const std::string scenes = R"(,"scenes":[{"nodes":[0]},{"nodes":[2]},{"nodes":[2,0]}],"scene":)";
  EXPECT_EQ(placed(nodes + scenes + "0").positions[0], Vec3d(0, 0, 0));
  EXPECT_EQ(placed(nodes + scenes + "1").positions[0], Vec3d(1, 0, 0));
  EXPECT_EQ(placed(nodes + scenes + "2").positions[3], Vec3d(0, 0, 0));
}

TEST(Gltf, ReadsInterleavedNormalizedAttributes) {
  Gltf gltf;
  // x y z as floats, then u v as normalized bytes and two bytes of padding: 16 bytes per vertex.
  std::string bytes;
  for (const Vec3d& p : kTriangle) {
    for (const double x : {p.x, p.y, p.z}) append(bytes, static_cast<float>(x));
    for (const std::uint8_t part : {51, 255, 0, 0}) append(bytes, part);
  }
  const std::string text =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":48,"uri":"data:;base64,)" + base64_of(bytes) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":48,"byteStride":16}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":0,"byteOffset":12,"componentType":5121,"normalized":true,"count":3,"type":"VEC2"}],)"
      R"("extensionsRequired":["KHR_texture_transform"],"images":[{"uri":"http://elsewhere/a.png"}],)"
      R"("meshes":[{"primitives":[{"mode":1,"attributes":{}},{"attributes":{"POSITION":0,"TEXCOORD_0":1}}]}],)"
      R"("nodes":[{"mesh":0,"extras":{"a":[[[]]]}}]})";
  const TriangleMesh mesh = read_mesh(text);
  EXPECT_EQ(mesh.positions, kTriangle);
  EXPECT_EQ(mesh.uvs[2], (std::array<double, 2>{0.2, 0}));  // glTF counts v from the top, so it is flipped
}

TEST(Gltf, DropsAttributesMissingInSomePrimitives) {
  Gltf gltf;
  gltf.positions(kTriangle);
  gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
  const TriangleMesh mesh = read_mesh(
      gltf.glb(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}},)"
               R"({"attributes":{"POSITION":0}},{"attributes":{"POSITION":0,"NORMAL":1}}]}])"));
  EXPECT_EQ(mesh.positions.size(), 9u);
  EXPECT_TRUE(mesh.normals.empty());
}

// A sparse accessor replaces elements of a buffer view, or of zeros without one.
TEST(Gltf, ReadsSparseAccessors) {
  const auto places = [](const char* view) {
    Gltf gltf;
    gltf.positions(kTriangle);
    gltf.add<std::uint16_t>({1, 2}, "SCALAR", 5123);
    gltf.positions({{5, 0, 0}, {0, 7, 0}});
    const std::string sparse = gltf.glb(one_mesh_of("0"));
    return read_mesh(
               replaced(sparse, R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
                        std::string("{") + view +
                            R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,)"
                            R"("indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}})"))
        .positions;
  };
  EXPECT_EQ(places(R"("bufferView":0,)"), (std::vector<Vec3d>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}));
  EXPECT_EQ(places(""), (std::vector<Vec3d>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}));
}

TEST(Gltf, ReadsBuffersFromOtherFiles) {
  Gltf gltf;
  gltf.positions(kTriangle);
  const std::string text = gltf.with_file(one_mesh_of("0"), "the%20buffer.bin");
  std::vector<std::string> asked;
  const ReadNearby nearby = [&](const std::string& name) {
    asked.push_back(name);
    return gltf.binary();
  };
  EXPECT_EQ(read_mesh(text, {}, nearby).positions, kTriangle);
  EXPECT_EQ(asked, std::vector<std::string>{"the buffer.bin"});
  EXPECT_THAT(problem(text),
              HasSubstr("/buffers/0/uri: must be a data: URI in base64, because other files are "
                        "not read (got \"the%20buffer.bin\"); a .glb file contains its buffers"));
  const auto error_near = [](const std::string& file, const ReadNearby& read) {
    return error_of([&] { read_mesh(file, {}, read); });
  };
  const ReadNearby missing = [](const std::string& name) -> std::string {
    throw InputError("", "cannot read " + name);
  };
  EXPECT_THAT(error_near(text, missing), HasSubstr("/buffers/0/uri: cannot read the buffer.bin"));
  EXPECT_THAT(error_near(gltf.with_file(one_mesh_of("0"), "http://host/b.bin"), nearby),
              HasSubstr("must be a data: URI in base64, or the name of a file"));
}

TEST(Gltf, NotesContentsThatAreNotModelled) {
  Gltf gltf;
  gltf.positions(kTriangle);
  const TriangleMesh mesh = read_mesh(gltf.glb(
      one_mesh_of("0") +
      R"(,"materials":[{},{}],"extensionsUsed":["KHR_materials_iridescence","KHR_mesh_quantization","EXT_texture_webp"])"));
  EXPECT_EQ(mesh.notes,
            (std::vector<std::string>{"extension \"KHR_materials_iridescence\" is not modelled"}));
}

}  // namespace
}  // namespace orrery::test
