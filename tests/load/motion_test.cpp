#include <gtest/gtest.h>

#include "core/load/load.h"
#include "core/params/document.h"
#include "tests/support/covers.h"
#include "tests/support/scenes.h"

// Tests the validation of motion in scenes.
namespace orrery::test {
namespace {

Json mesh_with(const char* motion, const char* more = "{}") {
  Json scene = scene_of(
      R"([{'type': 'mesh', 'positions': [[0, 0, 0], [1, 0, 0], [0, 1, 0]], 'indices': [[0, 1, 2]]}])");
  scene["objects"][0].merge_patch(json(more));
  scene["objects"][0]["motion"] = json(motion);
  return scene;
}

Json instance_with(const char* motion) {
  return scene_of(
      R"([{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}])",
      (R"({'models': {'it': {'objects': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'white'}]}},
                       'instances': [{'model': 'it', 'motion': )" +
       std::string(motion) + "}]}")
          .c_str());
}

TEST(LoadMotion, RejectsInvalidKeyframes) {
  covers("F19");
  const std::pair<const char*, const char*> instances[] = {
      {"[]", "accepted"},
      {"[{'time': 0}, {'time': 1}]", "accepted"},
      {"[{'time': 0}]", "/instances/0/motion"},
      {"[{'time': 1}, {'time': 1}]", "/instances/0/motion/1/time"},
      {"[{'time': 1}, {'time': 0}]", "/instances/0/motion/1/time"},
      {"[{'time': 0}, {}]", "/instances/0/motion/1"},
      {"[{'time': -1e6}, {'time': 1000001}]", "/instances/0/motion/1/time"},
      {"[{'time': 0}, {'time': 1, 'scale': [1, -1, 1]}]", "/instances/0/motion/1/scale"},
      {"[{'time': 0}, {'time': 1, 'scale': [1, 0, 1]}]", "/instances/0/motion/1/scale"},
      {"[{'time': 0}, {'time': 1, 'degrees': 1e7}]", "/instances/0/motion/1/degrees"},
      {"[{'time': 0}, {'time': 1, 'translate': [1e13, 0, 0]}]", "/instances/0/motion/1/translate/0"},
      {"[{'time': 0}, {'time': 1, 'rotate': {}}]", "/instances/0/motion/1"},
      {"{'time': 0}", "/instances/0/motion"},
  };
  for (const auto& [motion, expected] : instances)
    EXPECT_EQ(first_problem(instance_with(motion)), expected) << motion;
  const std::pair<const char*, const char*> meshes[] = {
      {"[{'time': 0}, {'time': 1, 'positions': [[0, 0, 0], [1, 0, 0], [0, 2, 0]]}]", "accepted"},
      {"[{'time': 0}, {'time': 1, 'positions': [[0, 0, 0], [1, 0, 0]]}]", "/objects/0/motion/1/positions"},
      {"[{'time': 0}, {'time': 1, 'positions': [[0, 0, 0], [1, 0, 0], [0, 1, 1e13]]}]",
       "/objects/0/motion/1/positions/2/2"},
      {"[{'time': 0}, {'time': 1, 'normals': [[0, 0, 1], [0, 0, 1], [0, 0, 1]]}]",
       "/objects/0/motion/1/normals"},
      {"[{'time': 0}, {'time': 1, 'file': 'a.obj'}]", "/objects/0/motion/1/file"},
      {"[{'time': 0}, {'time': 1, 'indices': [[0, 1, 2]]}]", "/objects/0/motion/1"},
  };
  for (const auto& [motion, expected] : meshes)
    EXPECT_EQ(first_problem(mesh_with(motion)), expected) << motion;
}

class Stages final : public AssetSource {
 public:
  MeshModelPtr model_file(const std::string& name, const ModelState&) const override {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, name == "a.obj" ? 0.0 : 2.0}};
    mesh.triangles = {{0, 1, 2}};
    if (name == "turned.obj") mesh.triangles = {{0, 2, 1}};
    if (name == "larger.obj") mesh.positions.push_back({9, 9, 9});
    return model_of(mesh);
  }
};

std::string problem_of_files(const char* motion) {
  Json scene = scene_of(R"([{'type': 'mesh', 'file': 'a.obj'}])");
  scene["objects"][0]["motion"] = json(motion);
  try {
    load_scene(scene.dump(), Stages());
    return "accepted";
  } catch (const InputError& error) {
    return error.problems().front().pointer;
  }
}

TEST(LoadMotion, RejectsKeyframeFilesOfOtherTopology) {
  EXPECT_EQ(problem_of_files("[{'time': 0}, {'time': 1, 'file': 'b.obj'}]"), "accepted");
  EXPECT_EQ(problem_of_files("[{'time': 0}, {'time': 1, 'file': 'turned.obj'}]"), "/objects/0/motion/1");
  EXPECT_EQ(problem_of_files("[{'time': 0}, {'time': 1, 'file': 'larger.obj'}]"),
            "/objects/0/motion/1/positions");
  EXPECT_EQ(
      problem_of_files(
          "[{'time': 0}, {'time': 1, 'file': 'b.obj', 'positions': [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}]"),
      "/objects/0/motion/1");
}

// Asset source that returns a mesh of 100,000 vertices for every name, and counts the reads.
class LargeMeshSource final : public AssetSource {
 public:
  mutable int read = 0;
  MeshModelPtr model_file(const std::string&, const ModelState&) const override {
    ++read;
    TriangleMesh mesh;
    mesh.positions.resize(100'000, Vec3d(1, 2, 3));
    mesh.triangles = {{0, 1, 2}};
    return model_of(mesh);
  }
};

TEST(LoadMotion, CountsKeyframesBeforeAllocation) {
  Json scene = scene_of(R"([{'type': 'mesh', 'file': 'a.obj'}])");
  for (int i = 0; i < 2'000; ++i) scene["objects"][0]["motion"].push_back({{"time", i}, {"file", "a.obj"}});
  const LargeMeshSource heavy;
  try {
    load_scene(scene.dump(), heavy);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().pointer, "/objects/0/motion/99");
    EXPECT_NE(error.problems().front().detail.find("vertices (limit 10,000,000, mesh_vertices)"),
              std::string::npos);
    EXPECT_EQ(error.problems().size(), 1u);
  }
  EXPECT_EQ(heavy.read, 1) << "each file is read once";
}

TEST(LoadMotion, IgnoresMotionOfUnusedModels) {
  Json scene = instance_with("[{'time': 0}, {'time': 1}]");
  scene["models"]["unused"]["objects"] = mesh_with("[{'time': -100}, {'time': 100}]")["objects"];
  EXPECT_EQ(load(scene)->motion.last, 1);
  EXPECT_EQ(load(scene)->motion.first, 0);
}

TEST(LoadMotion, InterpolatesBetweenKeyframes) {
  const auto scene =
      load(mesh_with("[{'time': 2}, {'time': 4, 'positions': [[0, 0, 0], [3, 0, 0], [0, 1, 0]]}, {'time': 5, "
                     "'positions': [[0, 0, 0], [3, 0, 0], [0, 9, 0]]}]"));
  EXPECT_EQ(scene->motion.first, 2);
  EXPECT_EQ(scene->motion.last, 5);
  const auto box = [&](double time) {
    for (const auto& shapes : scene->shapes)
      if (shapes->size() > 0) return shapes->at(time)->bounds(0).hi;
    return Vec3d();
  };
  EXPECT_EQ(box(0), Vec3d(1, 1, 0));
  EXPECT_EQ(box(2), Vec3d(1, 1, 0));
  EXPECT_EQ(box(3), Vec3d(2, 1, 0));
  EXPECT_EQ(box(4), Vec3d(3, 1, 0));
  EXPECT_EQ(box(4.5), Vec3d(3, 5, 0));
  EXPECT_EQ(box(99), Vec3d(3, 9, 0));
}

// Static meshes before and after a moving mesh keep their triangles.
TEST(LoadMotion, LeavesStaticMeshesUnchanged) {
  Json scene = mesh_with("[{'time': 0}, {'time': 1, 'positions': [[0, 0, 0], [5, 0, 0], [0, 1, 0]]}]");
  const Json resting = json(
      R"({'type': 'mesh', 'positions': [[7, 0, 0], [8, 0, 0], [7, 1, 0], [9, 9, 9]], 'indices': [[0, 1, 2]], 'material': 'white',
          'normals': [[0, 0, 1], [0, 1, 1], [1, 0, 1], [1, 0, 0]]})");
  scene["objects"] = {resting, scene["objects"][0], resting};
  const auto loaded = load(scene);
  for (const auto& shapes : loaded->shapes) {
    if (shapes->size() == 0) continue;
    const auto posed = shapes->at(1);
    ASSERT_EQ(posed->size(), 3);
    EXPECT_EQ(posed->bounds(0).hi, Vec3d(8, 1, 0));
    EXPECT_EQ(posed->bounds(1).hi, Vec3d(5, 1, 0));
    EXPECT_EQ(posed->bounds(2).hi, Vec3d(8, 1, 0));
    EXPECT_EQ(posed->bounds(2).lo, Vec3d(7, 0, 0));
  }
}

}  // namespace
}  // namespace orrery::test
