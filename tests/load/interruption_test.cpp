#include <gtest/gtest.h>

#include "core/accelerators/registry.h"
#include "core/base/task_scope.h"
#include "core/load/load.h"
#include "core/meshes/gltf_json.h"
#include "core/meshes/repair.h"
#include "core/params/document.h"
#include "core/prepare/prepared_scene.h"
#include "tests/meshes/writers.h"
#include "tests/support/scenes.h"

// Tests that parsing, loading and building stop on request, whatever the size of the input.
namespace orrery {
namespace {

// Returns true if `act` throws Cancelled after a stop request. Requires `act` to succeed without a stop
// request.
template <class Act>
bool is_interrupted(const Act& act) {
  act();
  std::stop_source source;
  source.request_stop();
  const std::stop_token stop = source.get_token();
  const TaskScope scope({nullptr, &stop});
  try {
    act();
  } catch (const Cancelled&) {
    return true;
  }
  return false;
}

const std::string kScene =
    test::scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'white'}").dump();

TEST(Interruption, StopsJsonParsing) {
  EXPECT_TRUE(is_interrupted([] { parse_document("[1, 2, 3]"); }));
}

TEST(Interruption, StopsGltfParsing) {
  EXPECT_TRUE(is_interrupted([] { parse_gltf("{}"); }));
}

TEST(Interruption, StopsSceneLoading) {
  const Document document = parse_document(kScene);
  EXPECT_TRUE(is_interrupted([&] { load_scene(document); }));
}

TEST(Interruption, StopsMeshReading) {
  const TriangleMesh cube = test::cube();
  for (const std::string& bytes :
       {test::obj_of(cube), test::ply_of(cube), test::ply_of(cube, std::endian::little),
        test::ascii_stl_of(cube), test::binary_stl_of(cube)})
    EXPECT_TRUE(is_interrupted([&] { read_mesh(bytes); })) << bytes.substr(0, 60);
}

TEST(Interruption, StopsSmoothing) {
  EXPECT_TRUE(is_interrupted([] {
    TriangleMesh mesh = test::cube();
    smooth_normals(mesh, 30);
  }));
}

TEST(Interruption, StopsBuildOfEveryAccelerator) {
  const auto scene = load_scene(kScene);
  for (const AcceleratorType& type : accelerator_types())
    EXPECT_TRUE(is_interrupted([&] {
      double build_ms = 0;
      const std::stop_token* const stop = TaskScope::current().stop;
      world_for<float>(PreparedScene(scene).parts(), type, 0, build_ms, stop ? *stop : std::stop_token());
    })) << type.name;
}

// The next caller repeats an interrupted build.
TEST(Interruption, LeavesNoPartialBuild) {
  const PreparedScene scene(load_scene(kScene));
  std::stop_source source;
  source.request_stop();
  double build_ms = 0;
  const AcceleratorType& type = accelerator_types()[0];
  EXPECT_THROW(world_for<float>(scene.parts(), type, 0, build_ms, source.get_token()), Cancelled);
  EXPECT_EQ(world_for<float>(scene.parts(), type, 0, build_ms).geometry->primitives.size(), 1u);
}

class CountedTurn final : public TimeSlice {
 public:
  void yield() override { ++asked; }
  std::atomic<int> asked{0};
};

TEST(Interruption, YieldsWhileLoading) {
  CountedTurn turn;
  const TaskScope scope({nullptr, nullptr, &turn});
  load_scene(kScene);
  EXPECT_GT(turn.asked, 0);
}

// A thread that holds the scene's lock must not yield its slot. Otherwise threads that wait for the lock
// could take all slots, and the thread could not continue.
TEST(Interruption, NeverYieldsWhileSceneIsLocked) {
  const PreparedScene scene(load_scene(kScene));
  CountedTurn turn;
  const TaskScope scope({nullptr, nullptr, &turn});
  double build_ms = 0;
  world_for<float>(scene.parts(), accelerator_types()[0], 0, build_ms);
  EXPECT_EQ(turn.asked, 0);
}

}  // namespace
}  // namespace orrery
