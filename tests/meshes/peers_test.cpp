#include <gtest/gtest.h>

#include <fstream>  // missing in tiny_gltf.h

#include "tests/meshes/writers.h"
#include "tests/support/random.h"

// Compares the mesh readers with tinyobjloader and tinygltf.

#if __has_include(<tiny_obj_loader.h>)
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
#endif
#if __has_include(<tiny_gltf.h>)
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>
#endif

namespace orrery::test {
namespace {

#ifdef TINYOBJLOADER_IMPLEMENTATION

std::string random_obj(Random& random) {
  std::string text;
  int v = 0, vt = 0, vn = 0;
  for (int block = 0; block < 5; ++block) {
    for (int i = 0; i < 20; ++i, ++v) text += "v " + words(random.in_cube(100)) + '\n';
    for (int i = 0; i < 9; ++i, ++vt)
      text += "vt " + number(random.unit()) + ' ' + number(random.unit()) + '\n';
    for (int i = 0; i < 7; ++i, ++vn) text += "vn " + words(random.direction()) + '\n';
    for (int i = 0; i < 30; ++i) {
      text += 'f';
      const auto index = [&](int count) {
        const int i1 = random.below(count);
        return std::to_string(random.below(2) ? i1 + 1 : i1 - count);
      };
      for (int k = 0; k < 3; ++k) text += ' ' + index(v) + '/' + index(vt) + '/' + index(vn);
      text += '\n';
    }
  }
  return text;
}

// tinyobjloader parses decimals with errors of a few units in the last place, so coordinates need a
// tolerance.
TEST(MeshFile, MatchesTinyobjloader) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const std::string text = random_obj(random);
    tinyobj::ObjReader peer;
    ASSERT_TRUE(peer.ParseFromString(text, ""));
    const auto& attributes = peer.GetAttrib();
    const auto& theirs = peer.GetShapes().at(0).mesh.indices;
    const TriangleMesh ours = read_mesh(text);
    ASSERT_EQ(theirs.size(), 3 * ours.triangles.size());
    for (std::size_t i = 0; i < theirs.size(); ++i) {
      const std::uint32_t vertex = ours.triangles[i / 3][i % 3];
      const auto three = [](const std::vector<double>& values, int index) {
        const double* at = &values.at(3 * static_cast<std::size_t>(index));
        return Vec3d(at[0], at[1], at[2]);
      };
      EXPECT_LE(length(ours.positions[vertex] - three(attributes.vertices, theirs[i].vertex_index)), 1e-12);
      EXPECT_LE(length(ours.normals[vertex] - three(attributes.normals, theirs[i].normal_index)), 1e-14);
      const auto uv = 2 * static_cast<std::size_t>(theirs[i].texcoord_index);
      EXPECT_NEAR(ours.uvs[vertex][0], attributes.texcoords.at(uv), 1e-14);
      EXPECT_NEAR(ours.uvs[vertex][1], attributes.texcoords.at(uv + 1), 1e-14);
    }
  }
}
#endif

#ifdef TINYGLTF_IMPLEMENTATION
TEST(MeshFile, MatchesTinygltf) {
  for (const bool binary : {true, false}) {
    const std::string bytes = binary ? gltf_of(cube()).glb(kOneMesh) : gltf_of(cube()).gltf(kOneMesh);
    tinygltf::TinyGLTF peer;
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned int>(bytes.size());
    ASSERT_TRUE(binary ? peer.LoadBinaryFromMemory(&model, &error, &warning,
                                                   reinterpret_cast<const unsigned char*>(bytes.data()), size)
                       : peer.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, ""))
        << error;
    const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
    const auto data = [&](int accessor) {
      const tinygltf::BufferView& view = model.bufferViews.at(
          static_cast<std::size_t>(model.accessors.at(static_cast<std::size_t>(accessor)).bufferView));
      return model.buffers.at(0).data.data() + view.byteOffset;
    };
    const TriangleMesh ours = read_mesh(bytes);
    const std::vector<Corners> corners = corners_of(ours);
    for (std::size_t i = 0; i < 3 * corners.size(); ++i) {
      std::uint16_t index;
      std::memcpy(&index, data(primitive.indices) + 2 * i, 2);
      std::array<float, 3> p;
      std::memcpy(p.data(), data(primitive.attributes.at("POSITION")) + 12 * index, 12);
      EXPECT_EQ(corners[i / 3][i % 3], Vec3d(p[0], p[1], p[2]));
    }
  }
}
#endif

}  // namespace
}  // namespace orrery::test
