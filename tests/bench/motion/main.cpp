#include <oneapi/tbb/global_control.h>

#include <nlohmann/json.hpp>

#include "core/model/camera.h"
#include "core/plan/plan.h"
#include "core/prepare/geometry.h"
#include "core/prepare/trial.h"
#include "tests/bench/measuring.h"

// Compares a BVH that is refitted frame by frame to the motion of a scene with a BVH built for the last
// frame.
//   motion SCENE.json ready   prepares the last frame, starting from the previous one
//   motion SCENE.json rays    traces some tiles of the last frame
// Prints facts of the frames as JSON. Then, for each input line "ours" (refitted) or "theirs" (built),
// runs this side once and prints the CPU seconds.
namespace orrery::bench {
namespace {

constexpr int kFrames = 40, kTiles = 64;
constexpr double kMinRunSeconds = 0.1;  // minimum duration of a run

World<float> make(const std::shared_ptr<const Scene>& scene, const Plan& plan, double time,
                  const World<float>& before) {
  const auto geometry = make_geometry<float>(scene, *plan.accelerator, time, before.geometry.get());
  return {geometry, build_or_refit(*plan.accelerator, geometry->primitives, before.accelerator.get())};
}

int run(const std::string& path, const std::string& what) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const auto scene = load_scene_at(path);
  RenderRequest request;
  request.precision = Precision::single_precision;
  request.accelerator = "bvh";
  const Plan plan = make_plan(*scene, request);
  World<float> before, followed;
  int refitted = 0;
  double worst = 1;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double share = static_cast<double>(frame) / (kFrames - 1);
    before = followed;
    followed =
        make(scene, plan, scene->motion.first + share * (scene->motion.last - scene->motion.first), before);
    refitted += followed.accelerator->facts().refitted;
    worst = std::max(worst, followed.accelerator->facts().surface_area_growth);
  }
  const PrimitiveList<float>& primitives = followed.geometry->primitives;
  const World<float> fresh{followed.geometry, build_or_refit<float>(*plan.accelerator, primitives, nullptr)};
  const auto seconds_of = [&](bool ours) {
    const double start = thread_seconds();
    if (what == "rays")
      try_tiles<float>(ours ? followed : fresh, plan, kTiles);
    else
      build_or_refit<float>(*plan.accelerator, primitives, ours ? before.accelerator.get() : nullptr);
    return thread_seconds() - start;
  };
  seconds_of(true);
  const int repeats = std::max(1, static_cast<int>(kMinRunSeconds / seconds_of(false)));
  std::printf("%s\n", nlohmann::json({{"frames", kFrames},
                                      {"refitted", refitted},
                                      {"surface_area_growth", worst},
                                      {"primitives", primitives.size()}})
                          .dump()
                          .c_str());
  std::fflush(stdout);
  serve_runs(repeats, seconds_of);
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count != 3) return 2;
  try {
    return orrery::bench::run(words[1], words[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion: %s\n", error.what());
    return 1;
  }
}
