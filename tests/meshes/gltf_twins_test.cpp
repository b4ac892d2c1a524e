#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/math/bounds.h"
#include "core/meshes/model.h"

// Compressed files that gltf-transform 4.5 wrote, and their uncompressed twin: a tube of radius 0.3 and
// height 2 with a skin, a morph target and an animation.
namespace orrery::test {
namespace {

TriangleMesh tube(const char* name, const std::optional<ModelPose>& pose) {
  std::ifstream file(std::string("tests/fuzz/corpus/mesh_file/") + name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  return read_model(bytes, {}, {}, {.pose = pose}).mesh;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a])) / 2;
  return sum;
}

// Positions have 14 bits (meshopt) or 11 bits or more (Draco), and rotations 16 bits.
TEST(GltfTwins, AgreeInEveryPose) {
  for (const char* name : {"tube-meshopt.glb", "tube-draco-sequential.glb"})
    for (const auto& pose : {std::optional<ModelPose>(), std::optional(ModelPose{0, 0}),
                             std::optional(ModelPose{0, 0.5}), std::optional(ModelPose{0, 1.5})}) {
      SCOPED_TRACE(testing::Message() << name << " at " << (pose ? pose->time : -1));
      const TriangleMesh plain = tube("tube.glb", pose), compressed = tube(name, pose);
      Boundsd plain_bounds, bounds;
      for (const Vec3d& p : plain.positions) plain_bounds.include(p);
      for (const Vec3d& p : compressed.positions) bounds.include(p);
      EXPECT_LE(length(bounds.lo - plain_bounds.lo), 1e-3);
      EXPECT_LE(length(bounds.hi - plain_bounds.hi), 1e-3);
      EXPECT_EQ(compressed.triangles.size(), 48u);
      EXPECT_NEAR(area_of(compressed), area_of(plain), 2e-3);
      EXPECT_EQ(compressed.normals.size(), compressed.positions.size());
      EXPECT_EQ(compressed.uvs.size(), compressed.positions.size());
    }
}

// Bounds that GLTFLoader and AnimationMixer of three.js r187 compute for the file.
TEST(GltfTwins, AgreeWithThreeJs) {
  const auto expect_bounds = [](double time, const Vec3d& lower, const Vec3d& upper) {
    Boundsd bounds;
    for (const Vec3d& p : tube("tube.glb", ModelPose{0, time}).positions) bounds.include(p);
    EXPECT_LE(length(bounds.lo - lower), 1e-7) << time;
    EXPECT_LE(length(bounds.hi - upper), 1e-7) << time;
  };
  expect_bounds(0.5, {0.19999998807907104, 0, -0.32917199085896154},
                {0.800000011920929, 1.8908185134028914, 0.8908184985615788});
  expect_bounds(1.5, {0.5000000014754065, 0, -0.5010949686776835},
                {2.041666679375272, 1.7886751392028866, 1.0386751180765033});
}

}  // namespace
}  // namespace orrery::test
