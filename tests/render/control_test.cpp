#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/base/error.h"
#include "core/load/load.h"
#include "core/prepare/staged_world.h"
#include "core/prepare/trial.h"
#include "tests/support/pictures.h"
#include "tests/support/stopped.h"

// Tests progress, cancellation and concurrency of renders.
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
  render_frame(prepared, settle(prepared, plan), FilmStorage::srgb8, shared_executor(), control);
  EXPECT_EQ(calls, 12);
  EXPECT_EQ(largest, 12);
}

TEST(Control, StopsRenderImmediately) {
  const PreparedScene prepared(paper());
  RenderRequest request = size(1000, 1000);
  std::atomic<int> tiles = 0;
  std::stop_source stop;
  RenderControl control{.stop = stop.get_token()};
  control.progress = [&](int, int) {
    if (++tiles == 5) stop.request_stop();
  };
  EXPECT_THROW(render_frame(prepared, settle(prepared, make_plan(*paper(), request)), FilmStorage::srgb8,
                            shared_executor(), control),
               Cancelled);
  EXPECT_LT(tiles, 5 + shared_executor().threads()) << "new tiles began after the stop";
}

// Accelerator that forwards to another accelerator and requests a stop at the third batch.
class StopsAtThirdBatch final : public Accelerator<float> {
 public:
  explicit StopsAtThirdBatch(std::shared_ptr<const Accelerator<float>> behind) : behind_(std::move(behind)) {}
  AcceleratorFacts facts() const override { return behind_->facts(); }
  void closest(const RayBatch<float>& rays, const LaneGroups& groups, HitBatch<float>& hits,
               AcceleratorCounts& counts) const override {
    if (++batches == 3) stop.request_stop();
    if (batches > 1000) throw std::runtime_error("the stop request has no effect");
    behind_->closest(rays, groups, hits, counts);
  }
  void occlude(RayBatch<float>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    behind_->occlude(rays, groups, counts);
  }

  mutable int batches = 0;
  mutable std::stop_source stop;

 private:
  const std::shared_ptr<const Accelerator<float>> behind_;
};

// The ray tree of one camera ray in glass can have billions of rays, so a stop must end it early.
TEST(Control, StopsInsideDeepRayTree) {
  std::string spheres;
  for (int i = 0; i < 27; ++i)
    spheres += std::string(i ? "," : "") + R"({"type":"sphere","material":"glass","radius":0.49,"center":[)" +
               std::to_string(i % 3 - 1) + "," + std::to_string(i / 3 % 3 - 1) + "," +
               std::to_string(i / 9 - 1) + "]}";
  const auto scene =
      load_scene(R"({"version":1,"camera":{"type":"perspective","eye":[3,2,4],"look_at":[0,0,0]},
      "materials":{"glass":{"type":"refractive","ior":1.5}},"render":{"max_depth":32},"objects":[)" +
                 spheres + "]}");
  const PreparedScene prepared(scene);
  const Plan plan = make_plan(*scene, size(8, 8));
  double build_ms = 0;
  World<float> world = staged_world<float>(prepared.parts(), settle(prepared, plan), build_ms);
  const auto stops = std::make_shared<const StopsAtThirdBatch>(world.accelerator);
  world.accelerator = stops;
  EXPECT_THROW(try_tiles(world, plan, 1, stops->stop.get_token()), Cancelled);
}

TEST(Control, RendersCompletelyAfterStop) {
  const PreparedScene prepared(paper());
  const Plan plan = make_plan(*paper(), size(64, 64));
  EXPECT_THROW(render_frame(prepared, settle(prepared, plan), FilmStorage::linear32, shared_executor(),
                            {.stop = stopped()}),
               Cancelled);
  EXPECT_EQ(render_frame(prepared, settle(prepared, plan), FilmStorage::linear32, shared_executor())
                .stats.counts.rays.camera,
            4096u);
}

// A stop request ends the wait for a structure that another thread builds.
TEST(Control, StopsWaitForConcurrentBuild) {
  StoppableMutex mutex;
  mutex.lock();
  std::stop_source stop;
  std::thread waits([&] { EXPECT_THROW(lock_unless(mutex, stop.get_token()), Cancelled); });
  stop.request_stop();
  waits.join();
  mutex.unlock();
  EXPECT_TRUE(mutex.lock_unless({}));
  mutex.unlock();
}

TEST(Control, RendersConcurrentlyWithoutInterference) {
  const Picture expected = render(paper(), size(128, 96));
  const PreparedScene prepared(paper());
  std::vector<std::jthread> callers;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 4; ++i)
    callers.emplace_back([&] {
      for (int frame = 0; frame < 5; ++frame) {
        const Image image = render_frame(prepared, settle(prepared, make_plan(*paper(), size(128, 96))),
                                         FilmStorage::linear32, shared_executor())
                                .film.image(PixelFormat::linear32);
        for (int y = 0; y < 96; y += 5)
          for (int x = 0; x < 128; x += 5) wrong += image.linear(x, y) != expected.at(x, y);
      }
    });
  callers.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(Control, PreparesSceneOnce) {
  const PreparedScene prepared(load(sample("sphereflake-3")));
  const Plan plan = make_plan(prepared.scene(), size(16, 16));
  EXPECT_GT(
      render_frame(prepared, settle(prepared, plan), FilmStorage::srgb8, shared_executor()).stats.build_ms,
      0);
  EXPECT_EQ(
      render_frame(prepared, settle(prepared, plan), FilmStorage::srgb8, shared_executor()).stats.build_ms,
      0);
}

// An orbit frame equals the image of a scene whose camera is at the same place.
TEST(Orbit, MatchesMovedCamera) {
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
