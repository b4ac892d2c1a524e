#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;

const std::string kMesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

std::string with(const std::string& rest) {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  gltf.add<std::uint16_t>({0, 1, 3}, "SCALAR", 5123);
  return problem(gltf.glb(rest));
}
std::string with_nodes(const std::string& nodes) { return with(kMesh + "\"nodes\":" + nodes); }
std::string with_primitive(const std::string& primitive) {
  return with("\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[" + primitive + "]}]");
}

// Reads a document of one triangle with the given buffers, buffer views and accessor, and returns the
// problem.
std::string with_data(const std::string& buffers, const std::string& views, const std::string& accessor) {
  return problem(R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],)" + kMesh + "\"buffers\":[" + buffers +
                 "],\"bufferViews\":[" + views + "],\"accessors\":[" + accessor + "]}");
}
const std::string kBuffer =
    "{\"byteLength\":36,\"uri\":\"data:;base64," + base64_of(std::string(36, '\0')) + "\"}";
const std::string kView = R"({"buffer":0,"byteLength":36})";
const std::string kAccessor = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";

TEST(Gltf, RejectsInvalidNodes) {
  EXPECT_EQ(with_nodes(R"([{"mesh":0,"children":[1]},{"children":[2]},{"children":[1]}])"),
            "/nodes/1: nodes must form a tree (got this node twice)");
  EXPECT_EQ(with(kMesh + R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}])"),
            "/nodes/0: nodes must form a tree (got this node twice)");
  EXPECT_EQ(with_nodes(R"([{"mesh":1}])"), "/meshes: must have entry 1 (got 1 entry)");
  EXPECT_EQ(with_nodes(R"([{"children":[7]}])"), "/nodes: must have entry 7 (got 1 entry)");
  EXPECT_EQ(with_nodes(R"([{"mesh":0,"matrix":[1,0]}])"), "/nodes/0/matrix: must be 16 numbers (got 2)");
  EXPECT_EQ(with_nodes(R"([{"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}])"),
            "/nodes/0/matrix: last row must be 0, 0, 0 and 1 (got a projection)");
  EXPECT_EQ(with_nodes(R"([{"mesh":0,"rotation":[0,0,0,0]}])"),
            "/nodes/0/rotation: must be a non-zero quaternion (got 0)");
  EXPECT_EQ(with_nodes(R"([{"mesh":0,"scale":[1,"2",3]}])"),
            "/nodes/0/scale/1: must be a number (got \"2\")");
  EXPECT_EQ(with_nodes(R"([{"mesh":4294967296}])"), "/meshes: must have entry 4294967296 (got 1 entry)");
  EXPECT_EQ(with_nodes(R"([{"mesh":-1}])"), "/nodes/0/mesh: must be an integer of at least 0 (got -1)");
  EXPECT_EQ(with_nodes(R"([{"mesh":0.5}])"), "/nodes/0/mesh: must be an integer of at least 0 (got 0.5)");
  EXPECT_THAT(with_nodes(R"([{"mesh":0,"scale":[1e308,1,1],"translation":[1e308,0,0]}])"),
              HasSubstr("/meshes/0/primitives/0/attributes: coordinates must be at most 1e+12 m "
                        "in magnitude (got (1e+308, 0, 0) at vertex 0)"));
}

TEST(Gltf, RejectsInvalidPrimitives) {
  EXPECT_EQ(with_primitive(R"({"attributes":{"POSITION":0},"mode":7})"),
            "/meshes/0/primitives/0: mode must be from 0 to 6 (got 7)");
  EXPECT_THAT(with_primitive(R"({"attributes":{}})"), HasSubstr("attributes: missing key \"POSITION\""));
  EXPECT_EQ(with_primitive(R"({"attributes":{"POSITION":0},"indices":1})"),
            "/meshes/0/primitives/0/indices: indices must be integers >= 0 and < 3 (got 3 at entry 2)");
  EXPECT_EQ(with_primitive(R"({"attributes":{"POSITION":1}})"),
            "/accessors/1/type: must be \"VEC3\" (got \"SCALAR\")");
  EXPECT_EQ(with_primitive(R"({"attributes":{"POSITION":2}})"),
            "/accessors: must have entry 2 (got 2 entries)");
}

TEST(Gltf, RejectsExternalFilesAndRequiredExtensions) {
  for (const char* uri : {"mesh.bin", "/etc/passwd", "http://elsewhere/mesh.bin", "data:text/plain,abc"})
    EXPECT_THAT(with_data(std::string(R"({"byteLength":36,"uri":")") + uri + "\"}", kView, kAccessor),
                HasSubstr("/buffers/0/uri: must be a data: URI in base64, because other files are not read "
                          "(got \"" +
                          std::string(uri)));
  EXPECT_THAT(with(kMesh + R"("nodes":[{"mesh":0}],"extensionsRequired":["EXT_mesh_gpu_instancing"])"),
              HasSubstr("/extensionsRequired/0: must be an extension that does not change geometry"));
}

TEST(Gltf, RejectsRangesOutsideBuffer) {
  EXPECT_EQ(with_data(kBuffer, kView, kAccessor), "accepted");
  EXPECT_EQ(with_data(R"({"byteLength":37,"uri":"data:;base64,AAAA"})", kView, kAccessor),
            "/buffers/0/byteLength: must be at most 3, the buffer size in bytes (got 37)");
  EXPECT_EQ(with_data(R"({"byteLength":3,"uri":"data:;base64,AA*A"})", kView, kAccessor),
            "/buffers/0/uri: must be base64 (got \"*\" at digit 2)");
  EXPECT_EQ(with_data(R"({"byteLength":36})", kView, kAccessor), "/buffers/0: missing key \"uri\"");
  for (const char* view :
       {R"({"buffer":0,"byteLength":37})", R"({"buffer":0,"byteLength":36,"byteOffset":1})",
        R"({"buffer":0,"byteLength":36,"byteOffset":18446744073709551600})"})
    EXPECT_THAT(
        with_data(kBuffer, view, kAccessor),
        HasSubstr(
            "/bufferViews/0: byteOffset + byteLength must be at most 36, the buffer size in bytes (got "));
  for (const char* rest :
       {R"("count":4)", R"("count":0)", R"("count":18446744073709551615)", R"("count":3,"byteOffset":1)",
        R"("count":1,"byteOffset":30)", R"("count":3,"byteOffset":18446744073709551615)"})
    EXPECT_THAT(
        with_data(kBuffer, kView,
                  std::string(R"({"bufferView":0,"componentType":5126,"type":"VEC3",)") + rest + "}"),
        HasSubstr(
            "/accessors/0: must have at least 1 element of 12 bytes, 12 bytes apart, within the 36 bytes"));
  EXPECT_THAT(with_data(kBuffer, R"({"buffer":0,"byteLength":36,"byteStride":16})", kAccessor),
              HasSubstr("16 bytes apart"));
  for (const char* stride : {"8", "0", "256", "18446744073709551615"})
    EXPECT_THAT(with_data(kBuffer, std::string(R"({"buffer":0,"byteLength":36,"byteStride":)") + stride + "}",
                          kAccessor),
                HasSubstr("byteStride must be from 12 to 252 (got "));
  EXPECT_THAT(with_data(kBuffer, kView, R"({"bufferView":0,"componentType":5124,"count":3,"type":"VEC3"})"),
              HasSubstr("/accessors/0/componentType: must be a component type"));
  const auto sparse = [](const std::string& text) {
    return with_data(
        kBuffer, kView,
        R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":)" + text + "}");
  };
  EXPECT_EQ(sparse("{}"), "/accessors/0/sparse: missing key \"indices\"");
  const std::string values = R"(,"values":{"bufferView":0}})";
  EXPECT_THAT(sparse(R"({"count":4,"indices":{"bufferView":0,"componentType":5121})" + values),
              HasSubstr("/accessors/0/sparse/count: must be at most 3, the count of the accessor (got 4)"));
  EXPECT_THAT(sparse(R"({"count":2,"indices":{"bufferView":0,"componentType":5121})" + values),
              HasSubstr("/accessors/0/sparse/indices: indices must be ascending integers >= 0 and < 3 (got 0 "
                        "at entry 1)"));
  EXPECT_THAT(with_data(kBuffer, kView, R"({"componentType":5126,"count":99999999999,"type":"VEC3"})"),
              HasSubstr("/accessors/0: count must be from 1 to 10,000,000 (got 99999999999)"));
}

TEST(Gltf, RejectsInvalidDocuments) {
  EXPECT_THAT(problem("{"), HasSubstr("JSON syntax error at byte 2"));
  EXPECT_EQ(problem("{}"), "/: missing key \"asset\"");
  EXPECT_EQ(problem(R"({"asset":{"version":"1.0"}})"),
            "/asset/version: must be \"2.0\" (got \"1.0\"); gltf-pipeline or Blender convert older files");
  EXPECT_THAT(problem(R"({"nodes":)" + std::string(100'000, '[')),
              HasSubstr("JSON is nested too deeply (limit 32 levels)"));
  std::string many = R"({"nodes":[0)";
  for (int i = 0; i < 1'000'000; ++i) many += ",0";
  EXPECT_THAT(problem(many + "]}"), HasSubstr("more than 1,000,000 JSON values (limit 1,000,000)"));
}

TEST(Gltf, RejectsInvalidContainers) {
  const std::string good = gltf_of(cube()).glb(kOneMesh);
  const auto changed = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = good, word;
    append(word, value);
    return problem(bytes.replace(at, 4, word));
  };
  EXPECT_EQ(problem("glTF"), "file must begin with a GLB header of 12 bytes (got 4 bytes)");
  EXPECT_EQ(changed(4, 1), "byte 4: must be GLB version 2 (got 1)");
  EXPECT_THAT(changed(8, static_cast<std::uint32_t>(good.size()) + 1),
              HasSubstr("byte 8: GLB length must be at most the file size"));
  EXPECT_THAT(changed(12, 0xffffffff), HasSubstr("byte 12: must be a GLB chunk of at most"));
  EXPECT_THAT(changed(16, 0),
              HasSubstr("byte 12: must be a non-empty GLB chunk of type \"JSON\" (got none)"));
  std::uint32_t json;
  std::memcpy(&json, good.data() + 12, 4);
  std::uint32_t binary;
  std::memcpy(&binary, good.data() + 20 + json, 4);
  EXPECT_THAT(changed(20 + json, binary + 1), HasSubstr("must be a GLB chunk of at most"));
  EXPECT_THAT(changed(20 + json, binary - 4), HasSubstr("/buffers/0/byteLength: must be at most"));
}

}  // namespace
}  // namespace orrery::test
