#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/base/error.h"
#include "core/load/load.h"
#include "tests/support/pictures.h"

// What a caller may do to a render while it runs, and several renders at once.
namespace orrery::test {
namespace {

const std::shared_ptr<const Scene>& paper() {
  static const auto scene = load(sample("paper"));
  return scene;
}

TEST(Control, CountsEveryTileOnce) {
  const PreparedScene prepared(paper());
  const Plan plan = make_plan(*paper(), size(100, 70));
  std::atomic<int> calls = 0, largest = 0;
  RenderControl control;
  control.progress = [&](int done, int total) {
    ++calls;
    EXPECT_EQ(total, 4 * 3);
    for (int seen = largest; done > seen && !largest.compare_exchange_weak(seen, done);) {
    }
  };
  render_frame(prepared, plan, PixelFormat::srgb8, shared_pool(), control);
  EXPECT_EQ(calls, 12);
  EXPECT_EQ(largest, 12);
}

TEST(Control, StopEndsTheRenderAtOnce) {
  const PreparedScene prepared(paper());
  RenderRequest request = size(1000, 1000);
  request.samples = 1000;
  std::atomic<int> asked = 0;
  RenderControl control;
  control.stop = [&] { return ++asked > 5; };
  EXPECT_THROW(
      render_frame(prepared, make_plan(*paper(), request), PixelFormat::srgb8, shared_pool(), control),
      Cancelled);
  EXPECT_LT(asked, 100) << "tiles were begun after the stop";
}

// Glass among glass: the tree of one camera ray can grow to billions, so a stop must not wait for its end.
TEST(Control, StopEndsARenderInsideOneDeepRayTree) {
  std::string spheres;
  for (int i = 0; i < 27; ++i)
    spheres += std::string(i ? "," : "") + R"({"type":"sphere","material":"glass","radius":0.49,"center":[)" +
               std::to_string(i % 3 - 1) + "," + std::to_string(i / 3 % 3 - 1) + "," +
               std::to_string(i / 9 - 1) + "]}";
  const auto scene =
      load_scene(R"({"version":1,"camera":{"type":"perspective","eye":[3,2,4],"look_at":[0,0,0]},
      "materials":{"glass":{"type":"refractive","ior":1.5}},"render":{"max_depth":32},"objects":[)" +
                 spheres + "]}");
  std::atomic<int> asked = 0;
  RenderControl control;
  control.stop = [&] { return ++asked > 3; };  // the one tile, then within its tree
  EXPECT_THROW(render_frame(PreparedScene(scene), make_plan(*scene, size(8, 8)), PixelFormat::srgb8,
                            shared_pool(), control),
               Cancelled);
  EXPECT_LT(asked, 10);
}

TEST(Control, AStoppedRenderLeavesTheNextOneWhole) {
  const PreparedScene prepared(paper());
  const Plan plan = make_plan(*paper(), size(64, 64));
  RenderControl control;
  control.stop = [] { return true; };
  EXPECT_THROW(render_frame(prepared, plan, PixelFormat::linear32, shared_pool(), control), Cancelled);
  EXPECT_EQ(render_frame(prepared, plan, PixelFormat::linear32, shared_pool()).stats.counts.rays.camera,
            4096u);
}

TEST(Control, RendersAtTheSameTimeDoNotDisturbEachOther) {
  const Picture expected = render(paper(), size(128, 96));
  const PreparedScene prepared(paper());
  std::vector<std::jthread> callers;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 4; ++i)
    callers.emplace_back([&] {
      for (int frame = 0; frame < 5; ++frame) {
        const Image image =
            render_frame(prepared, make_plan(*paper(), size(128, 96)), PixelFormat::linear32, shared_pool())
                .image;
        for (int y = 0; y < 96; y += 5)
          for (int x = 0; x < 128; x += 5) wrong += image.linear(x, y) != expected.at(x, y);
      }
    });
  callers.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(Control, PreparationIsPaidOnce) {
  const PreparedScene prepared(load(sample("sphereflake-3")));
  const Plan plan = make_plan(prepared.scene(), size(16, 16));
  EXPECT_GT(render_frame(prepared, plan, PixelFormat::srgb8, shared_pool()).stats.build_ms, 0);
  EXPECT_EQ(render_frame(prepared, plan, PixelFormat::srgb8, shared_pool()).stats.build_ms, 0);
}

// An orbit frame is the frame of a scene whose camera stands there.
TEST(Orbit, FramesAreThoseOfAMovedCamera) {
  Json scene = sample("paper");
  RenderRequest orbit = in_double(size(96, 64));
  orbit.azimuth_degrees = 90;
  orbit.distance = 2;
  Json moved_camera = scene;
  moved_camera["camera"]["eye"] = {8, 0, 0};
  EXPECT_LE(differing_pixels(render(scene, orbit), render(moved_camera, in_double(size(96, 64))), 1e-6), 0);
  EXPECT_GT(differing_pixels(render(scene, orbit), render(scene, in_double(size(96, 64))), 1e-3), 500);
}

}  // namespace
}  // namespace orrery::test
