#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "tests/meshes/writers.h"

// Encodes with libmeshoptimizer, and compares with the uncompressed mesh.
namespace orrery::test {
namespace {

using ::testing::HasSubstr;

std::string encoded_vertices(const void* vertices, std::size_t count, std::size_t bytes) {
  std::string out(meshopt_encodeVertexBufferBound(count, bytes), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), vertices,
                                        count, bytes));
  return out;
}
std::string encoded_triangles(const std::vector<std::uint32_t>& indices) {
  std::string out(meshopt_encodeIndexBufferBound(indices.size(), indices.size()), '\0');
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                       indices.data(), indices.size()));
  return out;
}
std::string encoded_indices(const std::vector<std::uint32_t>& indices) {
  std::string out(meshopt_encodeIndexSequenceBound(indices.size(), indices.size()), '\0');
  out.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                         indices.data(), indices.size()));
  return out;
}

// Builder of a document whose buffer views are compressed.
class Compressed {
 public:
  // Adds an accessor of `count` elements. `extension`: members "mode", "filter" and others.
  void add(const std::string& bytes, std::size_t count, std::size_t stride, const std::string& extension,
           const std::string& accessor) {
    const bool is_index = extension.find("ATTRIBUTES") == extension.npos;
    views_.push_back("{\"buffer\":1,\"byteLength\":" + std::to_string(count * stride) +
                     (is_index ? "" : ",\"byteStride\":" + std::to_string(stride)) +
                     ",\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":" +
                     std::to_string(binary_.size()) + ",\"byteLength\":" + std::to_string(bytes.size()) +
                     ",\"byteStride\":" + std::to_string(stride) + ",\"count\":" + std::to_string(count) +
                     "," + extension + "}}}");
    accessors_.push_back("{\"bufferView\":" + std::to_string(accessors_.size()) +
                         ",\"count\":" + std::to_string(count) + "," + accessor + "}");
    binary_ += bytes;
  }
  std::string gltf(const std::string& rest) const {
    return R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],)"
           R"("extensionsUsed":["EXT_meshopt_compression"],"buffers":[{"byteLength":)" +
           std::to_string(binary_.size()) + R"(,"uri":"data:;base64,)" + base64_of(binary_) +
           R"("},{"byteLength":1000,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],)" +
           "\"bufferViews\":[" + joined(views_) + "],\"accessors\":[" + joined(accessors_) + "]," + rest +
           "}";
  }

 private:
  static std::string joined(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) text += (text.empty() ? "" : ",") + item;
    return text;
  }
  std::string binary_;
  std::vector<std::string> views_, accessors_;
};

const std::string kFloat3 = R"("componentType":5126,"type":"VEC3")";
const std::string kAttributes = R"("mode":"ATTRIBUTES")";

std::vector<float> floats_of(const TriangleMesh& mesh) {
  std::vector<float> floats;
  for (const Vec3d& p : mesh.positions)
    for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
  return floats;
}
std::vector<std::uint32_t> indices_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> indices;
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  return indices;
}
Compressed compressed_cube(const std::string& indices, const std::string& mode, std::size_t width) {
  Compressed file;
  file.add(encoded_vertices(floats_of(cube()).data(), 8, 12), 8, 12, kAttributes, kFloat3);
  file.add(indices, 36, width, "\"mode\":\"" + mode + '"',
           std::string(R"("type":"SCALAR","componentType":)") + (width == 2 ? "5123" : "5125"));
  return file;
}

TEST(GltfMeshopt, ReadsVerticesAndIndices) {
  for (const std::size_t width : {2, 4})
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
      const auto indices = indices_of(cube());
      const TriangleMesh mesh = read_mesh(
          compressed_cube(mode[0] == 'T' ? encoded_triangles(indices) : encoded_indices(indices), mode, width)
              .gltf(kOneMesh));
      EXPECT_EQ(mesh.positions, cube().positions);
      // The encoder may rotate the corners of a triangle.
      ASSERT_EQ(mesh.triangles.size(), 12u);
      for (std::size_t i = 0; i < 12; ++i) {
        auto ours = mesh.triangles[i], theirs = cube().triangles[i];
        std::rotate(ours.begin(), std::min_element(ours.begin(), ours.end()), ours.end());
        std::rotate(theirs.begin(), std::min_element(theirs.begin(), theirs.end()), theirs.end());
        EXPECT_EQ(ours, theirs) << mode << ' ' << i;
      }
      EXPECT_TRUE(mesh.notes.empty());
    }
}

// The steps of an octahedral code with 8 bits are at most 1/127, measured along the octahedron.
TEST(GltfMeshopt, AppliesFilters) {
  std::vector<float> positions, normals;
  for (int i = 0; i < 100; ++i) {
    const Vec3d n = normalize(Vec3d(std::sin(i * 1.7), std::cos(i * 2.3), std::sin(i * 0.9 + 1)));
    for (const double x : {n.x, n.y, n.z, 0.0}) normals.push_back(static_cast<float>(x));
    for (const double x : {n.x, n.y, n.z}) positions.push_back(static_cast<float>(x * 1000));
  }
  std::string octahedral(400, '\0'), exponential(1200, '\0');
  meshopt_encodeFilterOct(octahedral.data(), 100, 4, 8, normals.data());
  meshopt_encodeFilterExp(exponential.data(), 100, 12, 16, positions.data());
  Compressed file;
  file.add(encoded_vertices(exponential.data(), 100, 12), 100, 12, kAttributes + R"(,"filter":"EXPONENTIAL")",
           kFloat3);
  file.add(encoded_vertices(octahedral.data(), 100, 4), 100, 4, kAttributes + R"(,"filter":"OCTAHEDRAL")",
           R"("componentType":5120,"normalized":true,"type":"VEC3")");
  const TriangleMesh mesh = read_mesh(file.gltf(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"mode":5,"attributes":{"POSITION":0,"NORMAL":1}}]}])"));
  ASSERT_EQ(mesh.positions.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    const Vec3d n = normalize(Vec3d(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]));
    EXPECT_LT(length(mesh.normals[i] - n), 0.02) << i;
    EXPECT_LT(length(mesh.positions[i] - n * 1000), 1000 * std::exp2(-14)) << i;
  }
}

TEST(GltfMeshopt, RejectsInvalidViews) {
  const std::string triangles = encoded_triangles(indices_of(cube()));
  const std::string good = compressed_cube(triangles, "TRIANGLES", 4).gltf(kOneMesh);
  const auto problem_with = [&](const std::string& part, const std::string& by) {
    std::string text = good;
    text.replace(text.rfind(part), part.size(), by);
    return problem(text);
  };
  EXPECT_EQ(problem(good), "accepted");
  EXPECT_THAT(problem_with(R"("mode":"TRIANGLES")", R"("mode":"LINES")"),
              HasSubstr("must be ATTRIBUTES, TRIANGLES or INDICES (got \"LINES\")"));
  EXPECT_THAT(problem_with(R"("mode":"TRIANGLES")", R"("mode":"TRIANGLES","filter":"OCTAHEDRAL")"),
              HasSubstr("must be NONE for indices"));
  EXPECT_THAT(problem_with(R"("mode":"ATTRIBUTES")", R"("mode":"ATTRIBUTES","filter":"QUATERNION")"),
              HasSubstr("byteStride must be 8 with filter QUATERNION (got 12)"));
  EXPECT_THAT(problem_with(R"("byteStride":12)", R"("byteStride":0)"), HasSubstr("from 4 to 256 (got 0)"));
  EXPECT_THAT(problem_with(R"("byteStride":12)", R"("byteStride":24)"),
              HasSubstr("count * byteStride must be 96, the byteLength of the buffer view (got 8 * 24)"));
  EXPECT_THAT(problem_with(R"("byteLength":)" + std::to_string(triangles.size()), R"("byteLength":9)"),
              HasSubstr("must be 36 compressed elements of 4 bytes (got 9 damaged bytes, code -2)"));
  // A small file that claims 4 GB, or 512 MB.
  for (const auto& [count, limit] : {std::pair(357913941ull, "decoded bytes (limit 1,073,741,824)"),
                                     std::pair(44739242ull, "byteLength must be at least 8388607 for")}) {
    std::string text = good;
    text.replace(text.find(R"("byteLength":96)"), 15, R"("byteLength":)" + std::to_string(12 * count));
    text.replace(text.find(R"("count":8)"), 9, R"("count":)" + std::to_string(count));
    EXPECT_THAT(problem(text), HasSubstr(limit));
  }
}

}  // namespace
}  // namespace orrery::test
