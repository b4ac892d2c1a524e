#include <draco/compression/encode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/meshes/writers.h"

// Encodes with libdraco, and compares with the uncompressed mesh.
namespace orrery::test {
namespace {

using ::testing::HasSubstr;

// Returns a torus of 8 x 6 vertices with normals and texture coordinates.
TriangleMesh torus() {
  constexpr std::uint32_t kAcross = 8, kAround = 6;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < kAcross; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const double a = 2 * std::numbers::pi * i / kAcross, b = 2 * std::numbers::pi * j / kAround;
      const Vec3d out(std::cos(a), std::sin(a), 0), n = out * std::cos(b) + Vec3d(0, 0, std::sin(b));
      const Vec3d p = out * 2 + n;
      mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      mesh.normals.push_back(n);
      mesh.uvs.push_back({i / 8.0, j / 8.0});
      const auto at = [&](std::uint32_t x, std::uint32_t y) { return x % kAcross * kAround + y % kAround; };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

// Encoded mesh with attributes 0 (positions), 1 (normals), 2 (texture coordinates) and 3 (colours, whose
// bytes are the number of the vertex).
struct EncodedMesh {
  std::string bytes;
  std::size_t points, faces;
};

template <class T>
int add_values(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, draco::DataType type,
               std::size_t components, const std::vector<T>& values) {
  draco::GeometryAttribute layout;
  layout.Init(kind, nullptr, static_cast<std::int8_t>(components), type, sizeof(T) == 1,
              static_cast<std::int64_t>(components * sizeof(T)), 0);
  const int id = mesh.AddAttribute(layout, true, mesh.num_points());
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[components * i]);
  return id;
}

EncodedMesh encoded(int method, int speed, int bits) {
  const TriangleMesh from = torus();
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(from.positions.size()));
  for (const auto& [a, b, c] : from.triangles)
    mesh.AddFace({draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
  std::vector<float> positions, normals, uvs;
  std::vector<std::uint8_t> colors;
  for (std::size_t i = 0; i < from.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(from.positions[i][k]));
    for (int k = 0; k < 3; ++k) normals.push_back(static_cast<float>(from.normals[i][k]));
    for (const double x : from.uvs[i]) uvs.push_back(static_cast<float>(x));
    for (int k = 0; k < 4; ++k) colors.push_back(static_cast<std::uint8_t>(i));
  }
  using Geometry = draco::GeometryAttribute;
  add_values(mesh, Geometry::POSITION, draco::DT_FLOAT32, 3, positions);
  add_values(mesh, Geometry::NORMAL, draco::DT_FLOAT32, 3, normals);
  add_values(mesh, Geometry::TEX_COORD, draco::DT_FLOAT32, 2, uvs);
  add_values(mesh, Geometry::COLOR, draco::DT_UINT8, 4, colors);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetTrackEncodedProperties(true);
  encoder.SetSpeedOptions(speed, speed);
  if (bits > 0)
    for (const auto kind : {Geometry::POSITION, Geometry::NORMAL, Geometry::TEX_COORD})
      encoder.SetAttributeQuantization(kind, bits);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  return {{buffer.data(), buffer.size()}, encoder.num_encoded_points(), encoder.num_encoded_faces()};
}

// Returns a document with the encoded mesh. `rest`: members of the primitive.
std::string gltf_with(const EncodedMesh& mesh, const std::string& rest) {
  const std::string count = ",\"count\":" + std::to_string(mesh.points),
                    size = std::to_string(mesh.bytes.size());
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],)"
         R"("extensionsUsed":["KHR_draco_mesh_compression"],"buffers":[{"byteLength":)" +
         size + R"(,"uri":"data:;base64,)" + base64_of(mesh.bytes) +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":)" + size + R"(}],"accessors":[)" +
         R"({"componentType":5126,"type":"VEC3")" + count + R"(},{"componentType":5126,"type":"VEC3")" +
         count + R"(},{"componentType":5126,"type":"VEC2")" + count +
         R"(},{"componentType":5121,"normalized":true,"type":"VEC4")" + count +
         R"(},{"componentType":5125,"type":"SCALAR","count":)" + std::to_string(3 * mesh.faces) +
         R"(}],"nodes":[{"mesh":0},{"mesh":0,"translation":[0,0,9]}],"scenes":[{"nodes":[0]}],"scene":0,)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3},)"
         R"("indices":4)" +
         rest + "}]}]}";
}
const std::string kDraco = R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":)"
                           R"({"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3}}})";

// Compares by colour, which is the number of the vertex, because the encoder changes the order.
void expect_torus(const TriangleMesh& mesh, double quantum) {
  const TriangleMesh want = torus();
  const auto vertex = [&](std::size_t i) {
    return static_cast<std::uint32_t>(std::lround(mesh.colors[i].x * 255));
  };
  ASSERT_EQ(mesh.positions.size(), want.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_LE(length(mesh.positions[i] - want.positions[vertex(i)]), quantum);
    EXPECT_LE(length(mesh.normals[i] - want.normals[vertex(i)]), quantum + 1e-7);
    EXPECT_NEAR(mesh.uvs[i][0], want.uvs[vertex(i)][0], quantum);
    EXPECT_NEAR(mesh.uvs[i][1], 1 - want.uvs[vertex(i)][1], quantum);
  }
  const auto sorted = [](auto triangles, const auto& number) {
    for (auto& t : triangles) {
      for (std::uint32_t& i : t) i = number(i);
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_EQ(sorted(mesh.triangles, vertex), sorted(want.triangles, [](std::uint32_t i) { return i; }));
}

TEST(GltfDraco, ReadsEveryConnectivity) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING})
    for (const int speed : {0, 5, 10})
      for (const int bits : {0, 12}) {
        SCOPED_TRACE(testing::Message() << "method " << method << " speed " << speed << " bits " << bits);
        const TriangleMesh mesh = read_mesh(gltf_with(encoded(method, speed, bits), kDraco));
        EXPECT_TRUE(mesh.notes.empty());
        // The extent is 6, and normals have two quantized coordinates from -1 to 1.
        expect_torus(mesh, bits == 0 ? 0 : 6 * std::exp2(-bits));
      }
}

TEST(GltfDraco, RejectsMeshesThatDifferFromAccessors) {
  const EncodedMesh mesh = encoded(draco::MESH_SEQUENTIAL_ENCODING, 5, 0);
  EXPECT_EQ(problem(gltf_with(mesh, kDraco)), "accepted");
  EXPECT_THAT(
      problem(gltf_with({mesh.bytes, 47, 96}, kDraco)),
      HasSubstr("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: Draco mesh must have 47 "
                "points, as its accessors state (got 48)"));
  EXPECT_THAT(problem(gltf_with({mesh.bytes, 48, 97}, kDraco)),
              HasSubstr("must have 97 triangles, as its accessors state (got 96)"));
  EXPECT_THAT(problem(gltf_with(mesh, kDraco + R"(,"mode":5)")),
              HasSubstr("mode: must be 4 for a Draco mesh"));
  const auto attributes = [&](const char* list) {
    return problem(
        gltf_with(mesh, R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":)" +
                            std::string(list) + "}}"));
  };
  EXPECT_THAT(attributes(R"({"POSITION":9})"), HasSubstr("Draco mesh must have attribute 9"));
  EXPECT_THAT(attributes(R"({"POSITION":2})"), HasSubstr("must have 3 components (got 2)"));
}

TEST(GltfDraco, RejectsDamagedMeshes) {
  EncodedMesh mesh = encoded(draco::MESH_SEQUENTIAL_ENCODING, 10, 0);
  ASSERT_EQ(mesh.bytes[13], 1);  // indices are stored as bytes from here
  mesh.bytes[15] = '\x60';
  EXPECT_THAT(problem(gltf_with(mesh, kDraco)), HasSubstr("indices of Draco mesh must be < 48 (got 96)"));
  mesh = encoded(draco::MESH_EDGEBREAKER_ENCODING, 5, 12);
  mesh.bytes.resize(mesh.bytes.size() / 2);
  EXPECT_THAT(problem(gltf_with(mesh, kDraco)), HasSubstr("Draco mesh is damaged"));
  mesh.bytes = "not a mesh";
  EXPECT_THAT(problem(gltf_with(mesh, kDraco)), HasSubstr("Draco mesh is damaged"));
}

// The counts of the header are read before memory is allocated for them.
TEST(GltfDraco, RejectsHugeCounts) {
  const EncodedMesh mesh = encoded(draco::MESH_SEQUENTIAL_ENCODING, 10, 0);
  EXPECT_THAT(problem(gltf_with({mesh.bytes, 2'000'000'000, 96}, kDraco)), HasSubstr("limit 10,000,000"));
  EncodedMesh huge = mesh;
  huge.bytes.replace(11, 2, "\xff\xff\xff\x3f\xff\xff\xff\x3f");  // 134 million triangles and points
  const std::string text = problem(gltf_with(huge, kDraco));
  EXPECT_THAT(text, testing::AnyOf(HasSubstr("Draco mesh is damaged"), HasSubstr("needs more memory")));
}

}  // namespace
}  // namespace orrery::test
