#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/meshes/model.h"
#include "tests/meshes/writers.h"

// Skins, morph targets and animations of glTF files.
namespace orrery::test {
namespace {

using ::testing::HasSubstr;

constexpr double kFloatError = 1e-6;

void expect_positions(const TriangleMesh& mesh, const std::vector<Vec3d>& want, double bound = kFloatError) {
  ASSERT_EQ(mesh.positions.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i)
    EXPECT_LE(length(mesh.positions[i] - want[i]), bound)
        << i << ": " << mesh.positions[i].x << ' ' << mesh.positions[i].y << ' ' << mesh.positions[i].z;
}
std::string half_turn_part() { return number(std::sqrt(0.5)); }

// A bar from (0, 0, 0) to (0, 2, 0), 1 wide. Joint 0 (node 1) is at the origin and joint 1 (node 2) at (0, 1,
// 0). Vertices at heights 0, 1 and 2 follow joint 0, both by half, and joint 1.
Gltf bar(const std::vector<float>& weights = {1,   0,   0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0,
                                              0.5, 0.5, 0, 0, 0, 1, 0, 0, 0,   1,   0, 0}) {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}});  // 0
  gltf.add<std::uint16_t>({0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}, "SCALAR", 5123);       // 1
  gltf.add<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4",
                         5121);     // 2
  gltf.add(weights, "VEC4", 5126);  // 3
  gltf.add<float>(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
      "MAT4", 5126);                                                                      // 4
  gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);  // 5
  return gltf;
}
// `joint`: members of node 2. `mesh_node`: members of the node of the mesh.
std::string bar_members(const std::string& joint, const std::string& mesh_node = "") {
  return R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"NORMAL":5},)"
         R"("indices":1}]}],"skins":[{"joints":[1,2],"inverseBindMatrices":4}],"nodes":[{"mesh":0,"skin":0)" +
         mesh_node + R"(},{"children":[2]},{"translation":[0,1,0])" + joint + "}]";
}
// Positions of the bar whose upper joint is turned by 90 degrees about x: (x, y, z) -> (x, -z, y) around (0,
// 1, 0). The middle is the mean of both joints' positions, which agree there.
const std::vector<Vec3d> kBentBar = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, 1}, {1, 1, 1}};

TEST(GltfPose, BendsSkinByJoints) {
  const std::string turn = ",\"rotation\":[" + half_turn_part() + ",0,0," + half_turn_part() + "]";
  const TriangleMesh mesh = read_mesh(bar().glb(bar_members(turn)));
  expect_positions(mesh, kBentBar);
  EXPECT_LE(length(mesh.normals[0] - Vec3d(0, 0, 1)), kFloatError);
  EXPECT_LE(length(mesh.normals[2] - normalize(Vec3d(0, -1, 1))), kFloatError);
  EXPECT_LE(length(mesh.normals[4] - Vec3d(0, -1, 0)), kFloatError);
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(GltfPose, IgnoresTransformOfSkinnedNode) {
  expect_positions(read_mesh(bar().glb(bar_members("", R"(,"translation":[7,8,9],"scale":[2,2,-2])"))),
                   {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}});
}

TEST(GltfPose, NormalizesWeightsOfJoints) {
  std::vector<float> weights(24, 0.0f);  // vertices without weights follow their first joint
  weights[16] = weights[17] = 3;         // vertex 4: half of each
  expect_positions(read_mesh(bar(weights).glb(bar_members(R"(,"scale":[1,3,1])"))),
                   {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 3, 0}, {1, 2, 0}});
}

TEST(GltfPose, KeepsFrontFacesOutsideIfJointsMirror) {
  std::vector<float> first(24, 0.0f);
  for (std::size_t i = 0; i < 24; i += 4) first[i + 1] = 1;
  const TriangleMesh mesh = read_mesh(bar(first).glb(bar_members(R"(,"scale":[-1,1,1])")));
  for (const Corners& c : corners_of(mesh)) EXPECT_GT(cross(c[1] - c[0], c[2] - c[0]).z, 0);
}

TEST(GltfPose, RejectsInvalidSkins) {
  const auto with = [](const std::string& part, const std::string& by) {
    std::string members = bar_members("");
    members.replace(members.find(part), part.size(), by);
    return problem(bar().glb(members));
  };
  EXPECT_THAT(with(R"("joints":[1,2])", R"("joints":[1])"),
              HasSubstr("joints must be integers >= 0 and < 1 (got 1 at vertex 0)"));
  EXPECT_THAT(with(R"("joints":[1,2])", R"("joints":[1,9])"),
              HasSubstr("/skins/0/joints/1: must be a node below a root (got 9)"));
  EXPECT_THAT(with(R"("joints":[1,2])", R"("joints":[1,2,2])"),
              HasSubstr("must have 3 matrices, one per joint (got 2)"));
  EXPECT_THAT(with(R"("WEIGHTS_0":3)", R"("WEIGHTS_1":3)"), HasSubstr("missing key \"WEIGHTS_0\""));
  EXPECT_THAT(with(R"("JOINTS_0":2)", R"("JOINTS_0":3)"), HasSubstr("joints must be integers"));
  EXPECT_THAT(problem(bar(std::vector<float>(24, -1.0f)).glb(bar_members(""))),
              HasSubstr("weights of joints must be from 0 to 1e6 (got -1 at vertex 0)"));
}

// A triangle with two morph targets. The second is sparse and changes vertex 2 only.
std::string morphed(const std::string& weights_of_mesh, const std::string& node) {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});           // 0
  gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);  // 1
  gltf.positions({{0, 0, 4}, {0, 0, 4}, {0, 2, 4}});           // 2
  gltf.add<float>({2, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 5126);  // 3
  gltf.add<std::uint16_t>({2}, "SCALAR", 5123);                // 4
  gltf.positions({{8, 0, 0}});                                 // 5
  gltf.add<float>({0, 1, 2}, "SCALAR", 5126);                  // 6: times
  gltf.add<float>({0, 0, 1, 0.5, 0, 1}, "SCALAR", 5126);       // 7: weights
  return gltf.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"targets":[)"
                  R"({"POSITION":2,"NORMAL":3},{"POSITION":8}]}])" +
                  weights_of_mesh + R"(}],"nodes":[{"mesh":0)" + node +
                  R"(}],"animations":[{"samplers":[{"input":6,)"
                  R"("output":7}],"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])");
}
// Adds accessor 8, which is sparse.
std::string with_sparse(std::string glb) {
  const std::string last = R"({"bufferView":7,"componentType":5126,"count":6,"type":"SCALAR"})";
  const std::string added = last +
                            R"(,{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":)"
                            R"({"bufferView":4,"componentType":5123},"values":{"bufferView":5}}})";
  std::string json = glb.substr(20, glb.find("BIN") - 24);
  const std::string binary = glb.substr(glb.find("BIN") - 4);
  json.replace(json.find(last), last.size(), added);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(20 + json.size() + binary.size()));
  append(out, static_cast<std::uint32_t>(json.size()));
  return out + "JSON" + json + binary;
}

TEST(GltfPose, AppliesMorphTargets) {
  const auto positions = [](const std::string& of_mesh, const std::string& of_node) {
    return read_mesh(with_sparse(morphed(of_mesh, of_node))).positions;
  };
  const std::vector<Vec3d> rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(positions("", ""), rest);
  EXPECT_EQ(positions(R"(,"weights":[0.5,0])", ""), (std::vector<Vec3d>{{0, 0, 2}, {1, 0, 2}, {0, 2, 2}}));
  EXPECT_EQ(positions(R"(,"weights":[0.5,0.25])", ""), (std::vector<Vec3d>{{0, 0, 2}, {1, 0, 2}, {2, 2, 2}}));
  EXPECT_EQ(positions(R"(,"weights":[0.5,0])", R"(,"weights":[0,1])"),
            (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {8, 1, 0}}));
  const TriangleMesh mesh = read_mesh(with_sparse(morphed(R"(,"weights":[0.5,0])", "")));
  EXPECT_LE(length(mesh.normals[0] - normalize(Vec3d(1, 0, 1))), 1e-15);
  EXPECT_LE(length(mesh.normals[1] - Vec3d(0, 0, 1)), 1e-15);
}

}  // namespace
}  // namespace orrery::test
