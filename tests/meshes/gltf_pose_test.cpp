#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
std::string with_sparse(const std::string& glb) {
  const std::string last = R"({"bufferView":7,"componentType":5126,"count":6,"type":"SCALAR"})";
  const std::string added = last +
                            R"(,{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":)"
                            R"({"bufferView":4,"componentType":5123},"values":{"bufferView":5}}})";
  return replaced(glb, last, added);
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

TEST(GltfPose, PosesMorphTargetsByAnimation) {
  const std::string glb = with_sparse(morphed("", R"(,"weights":[9,9])"));
  const auto height = [&](double time) {
    const TriangleMesh mesh = read_model(glb, {}, {}, {.pose = ModelPose{0, time}}).mesh;
    return std::array{mesh.positions[0].z, mesh.positions[2].x};
  };
  // Keyframes: weights (0, 0), (1, 0.5) and (0, 1). The targets move by 4 and 8.
  EXPECT_EQ(height(-1), (std::array{0.0, 0.0}));
  EXPECT_EQ(height(0.5), (std::array{2.0, 2.0}));
  EXPECT_EQ(height(1), (std::array{4.0, 4.0}));
  EXPECT_EQ(height(1.75), (std::array{1.0, 7.0}));
  EXPECT_EQ(height(5), (std::array{0.0, 8.0}));
}

// Returns a triangle in a node whose member `path` is animated. Keyframes are at 1, 2 and 4 s.
std::string animated(const std::string& path, const std::string& interpolation,
                     const std::vector<float>& values, const std::string& node = "") {
  Gltf gltf;
  gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  gltf.add<float>({1, 2, 4}, "SCALAR", 5126);
  gltf.add(values, path == "rotation" ? "VEC4" : "VEC3", 5126);
  return gltf.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0)" + node +
                  R"(}],"animations":[{"channels":[],"samplers":[]},{"samplers":[{"input":1,"output":2,)" +
                  R"("interpolation":")" + interpolation +
                  R"("}],"channels":[{"sampler":0,"target":{"node":0,"path":")" + path + R"("}}]}])");
}
Vec3d point_at(const std::string& glb, double time, std::size_t vertex) {
  return read_model(glb, {}, {}, {.pose = ModelPose{1, time}}).mesh.positions[vertex];
}

TEST(GltfPose, InterpolatesTranslationAndScale) {
  const std::vector<float> values = {1, 2, 4, 3, 4, 8, -1, 0, 16};
  const std::string linear = animated("translation", "LINEAR", values, R"(,"translation":[5,5,5])"),
                    step = animated("translation", "STEP", values),
                    scale = animated("scale", "LINEAR", values);
  EXPECT_EQ(point_at(linear, 0, 0), Vec3d(1, 2, 4));
  EXPECT_EQ(point_at(linear, 1.5, 0), Vec3d(2, 3, 6));
  EXPECT_EQ(point_at(linear, 3, 0), Vec3d(1, 2, 12));
  EXPECT_EQ(point_at(linear, 99, 0), Vec3d(-1, 0, 16));
  EXPECT_EQ(point_at(step, 1.99, 0), Vec3d(1, 2, 4));
  EXPECT_EQ(point_at(step, 2, 0), Vec3d(3, 4, 8));
  EXPECT_EQ(point_at(scale, 1.5, 1), Vec3d(2, 0, 0));
  EXPECT_EQ(point_at(scale, 1.5, 2), Vec3d(0, 3, 0));
}

// A quarter turn about z at constant angular velocity, then a turn of -120 degrees the shorter way, given by
// the quaternion of opposite sign.
TEST(GltfPose, InterpolatesRotationOnSphere) {
  const auto about_z = [](double degrees, double sign) {
    const double half = degrees / 360 * std::numbers::pi;
    return std::array{0.0f, 0.0f, static_cast<float>(sign * std::sin(half)),
                      static_cast<float>(sign * std::cos(half))};
  };
  std::vector<float> values;
  for (const auto& q : {about_z(0, 1), about_z(90, 1), about_z(-30, -1)})
    values.insert(values.end(), q.begin(), q.end());
  const std::string glb = animated("rotation", "LINEAR", values);
  for (const auto& [time, degrees] :
       {std::pair{1.0, 0.0}, {1.25, 22.5}, {1.9, 81}, {2, 90}, {2.5, 60}, {3.9, -24}}) {
    const double angle = degrees / 180 * std::numbers::pi;
    EXPECT_LE(length(point_at(glb, time, 1) - Vec3d(std::cos(angle), std::sin(angle), 0)), kFloatError)
        << time;
  }
}

// The spline between two keyframes is the cubic polynomial with the given values and slopes, so it reproduces
// any cubic polynomial.
TEST(GltfPose, InterpolatesCubicSplines) {
  const auto cubic = [](double t) { return Vec3d(t * t * t, 2 * t * t - t, 5 - t * t * t / 4); };
  const auto slope = [](double t) { return Vec3d(3 * t * t, 4 * t - 1, -0.75 * t * t); };
  std::vector<float> values;
  for (const double t : {1.0, 2.0, 4.0})
    for (const Vec3d& v : {slope(t), cubic(t), slope(t)})
      for (const double x : {v.x, v.y, v.z}) values.push_back(static_cast<float>(x));
  const std::string glb = animated("translation", "CUBICSPLINE", values);
  for (const double time : {1.0, 1.3, 2.0, 2.1, 3.0, 3.7, 4.0})
    EXPECT_LE(length(point_at(glb, time, 0) - cubic(time)), 1e-12) << time;
  EXPECT_LE(length(point_at(glb, 0, 0) - cubic(1)), 1e-12);
  EXPECT_LE(length(point_at(glb, 9, 0) - cubic(4)), 1e-12);
}

TEST(GltfPose, AnimatesJoints) {
  Gltf gltf = bar();
  gltf.add<float>({0, 2}, "SCALAR", 5126);  // 6
  const auto half = static_cast<float>(std::sqrt(0.5));
  gltf.add<float>({0, 0, 0, 1, half, 0, 0, half}, "VEC4", 5126);  // 7
  const std::string glb =
      gltf.glb(bar_members("") + R"(,"animations":[{"samplers":[{"input":6,"output":7}],)"
                                 R"("channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}}]}])");
  EXPECT_EQ(read_mesh(glb).notes, std::vector<std::string>{"the model is at rest, without its animation"});
  const TriangleMesh turned = read_model(glb, {}, {}, {.pose = ModelPose{0, 2}}).mesh;
  expect_positions(turned, kBentBar);
  EXPECT_TRUE(turned.notes.empty());
  const TriangleMesh halfway = read_model(glb, {}, {}, {.pose = ModelPose{0, 1}}).mesh;
  EXPECT_LE(length(halfway.positions[4] - Vec3d(0, 1 + std::sqrt(0.5), std::sqrt(0.5))), kFloatError);
}

TEST(GltfPose, RejectsInvalidAnimations) {
  const auto refusal_of = [](const std::string& file, const ModelPose& pose) {
    return error_of([&] { read_model(file, {}, {}, {.pose = pose}); });
  };
  const std::vector<float> values = {1, 2, 4, 3, 4, 8, -1, 0, 16};
  const std::string good = animated("translation", "LINEAR", values);
  EXPECT_EQ(refusal_of(good, {1, 1}), "accepted");
  EXPECT_THAT(refusal_of(good, {2, 1}), HasSubstr("/animations: must have entry 2 (got 2 entries)"));
  EXPECT_THAT(refusal_of(animated("translation", "CUBIC", values), {1, 1}),
              HasSubstr("must be LINEAR, STEP or CUBICSPLINE (got \"CUBIC\")"));
  EXPECT_THAT(refusal_of(animated("translation", "CUBICSPLINE", values), {1, 1}),
              HasSubstr("must have 9 elements (got 3)"));
  EXPECT_THAT(refusal_of(animated("rotation", "LINEAR", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), {1, 1}),
              HasSubstr("must be a non-zero quaternion (got 0)"));
  EXPECT_THAT(
      refusal_of(animated("translation", "LINEAR", values, R"(,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])"),
                 {1, 1}),
      HasSubstr("/nodes/0/matrix: must be translation, rotation and scale"));
  EXPECT_THAT(refusal_of(bar().glb(bar_members("")), {}), HasSubstr("must be a model with animations"));
  EXPECT_THAT(refusal_of(obj_of(cube()), {}),
              HasSubstr("must be a glTF file to have a pose at a time or a variant (got obj)"));
}

}  // namespace
}  // namespace orrery::test
