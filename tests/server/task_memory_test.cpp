#include <gtest/gtest.h>

#include "core/budget/budget.h"
#include "core/load/load.h"
#include "core/meshes/repair.h"
#include "server/scheduler/work_account.h"
#include "tests/support/pictures.h"

// Tests the memory that loading and rendering allocate, and their reactions to a refusal.
namespace orrery {
namespace {

// Requests a stop when the facet pass allocates its memory. No later pass may allocate memory.
TEST(TaskMemory, StopsSmoothingDuringFacetPass) {
  constexpr std::size_t kTriangles = 1000, kOfFacets = kTriangles * 3 * sizeof(Vec3d);
  constexpr std::size_t kOfIndices = kTriangles * 3 * sizeof(std::uint32_t);
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(kTriangles, {0, 1, 2});
  const PositionIndices places = position_indices_of(mesh.positions);
  std::stop_source source;
  std::size_t most = 0, taken_after = 0;
  const auto account = WorkAccount::open([&] {
    return [&](std::size_t bytes, bool) {
      if (source.stop_requested() && bytes > most) taken_after += bytes - most;
      if (bytes > most + kOfFacets / 2) source.request_stop();
      most = std::max(most, bytes);
      return bytes;
    };
  });
  EXPECT_THROW(account->run(source.get_token(), [&] { smooth_normals(mesh, 30, places); }), Cancelled);
  EXPECT_LT(taken_after, kOfIndices) << "only the exception may allocate memory";
}

// Asset source that returns a mesh of 100,000 vertices for every name.
class LargeMesh final : public AssetSource {
 public:
  MeshModelPtr model_file(const std::string&, const ModelState&) const override {
    TriangleMesh mesh;
    mesh.positions.resize(100'000, Vec3d(1, 2, 3));
    mesh.triangles = {{0, 1, 2}};
    return model_of(mesh);
  }
};

TEST(TaskMemory, SharesEqualDataAmongKeyframes) {
  const auto bytes = [](const char* keys) {
    test::Json scene = test::scene_of(R"([{'type': 'mesh', 'file': 'a.obj'}])");
    scene["objects"][0]["motion"] = test::json(keys);
    const auto account = WorkAccount::open([] { return [](std::size_t most, bool) { return most; }; });
    const auto loaded = account->run({}, [&] { return load_scene(scene.dump(), LargeMesh()); });
    return account->bytes();
  };
  const std::size_t few = bytes("[{'time': 0}, {'time': 1}]"),
                    vertices = LargeMesh().model_file("", {})->mesh.positions.size();
  EXPECT_LT(bytes("[{'time': 0}, {'time': 1}, {'time': 2}]"), few + 10'000);
  EXPECT_GE(bytes("[{'time': 0}, {'time': 1, 'file': 'b.obj'}]"), few + vertices * sizeof(Vec3d));
}

// If a copy of the film would exceed the memory limit, the render ends with the current film.
TEST(TaskMemory, KeepsImageIfMemoryRunsOut) {
  const auto scene = test::load(test::sample("paper"));
  RenderRequest r = test::size(1200, 1200);  // 35 MB of sums
  r.space = Space::display;
  r.technique = "raycast";
  r.seconds = 60;
  const auto account = WorkAccount::open([] {
    return [](std::size_t bytes, bool already) {
      if (!already && bytes > 60'000'000) throw Error("there is no more memory");
      return bytes;
    };
  });
  const RenderResult result =
      account->run({}, [&] { return test::rendered(scene, r, {.used_s = [] { return 0.0; }}); });
  EXPECT_EQ(result.budget->settings.samples, 2);
  EXPECT_TRUE(result.budget->met()) << "the request has no error budget";
}

}  // namespace
}  // namespace orrery
