#include <oneapi/tbb/global_control.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/occlusion/reordered.h"
#include "core/plan/plan.h"
#include "core/prepare/staged_world.h"
#include "core/prepare/trial.h"
#include "tests/bench/measuring.h"
#include "tests/support/random.h"

// Compares an accelerator behind a stage with the accelerator alone, on the rays of some tiles of an image.
//   stages SCENE.json STRUCTURE predict none|network|last|random   shadow rays
//   stages SCENE.json STRUCTURE known nearest                      camera rays with precomputed hits
//   stages SCENE.json STRUCTURE reorder camera|bounced|scattered   closest hits
// Prints facts of the rays as JSON. Then, for each input line "ours" (with the stage) or "theirs" (without),
// traces all rays once and prints the CPU seconds.
namespace orrery::bench {
namespace {

using nlohmann::ordered_json;

constexpr int kTiles = 64;
constexpr double kMinRunSeconds = 0.1;  // minimum duration of a run

// Rays of one recorded call, and already known hits.
struct Call {
  RayBatch<float> rays;
  LaneGroups groups;
  HitBatch<float> hits;
};
using Calls = std::vector<std::unique_ptr<Call>>;

std::unique_ptr<Call> call_of(const RayBatch<float>& rays, const LaneGroups& groups) {
  auto call = std::make_unique<Call>(Call{rays, groups, {}});
  call->hits.t = rays.t_max;
  call->hits.primitive.values.fill(kNoPrimitive);
  return call;
}

class Recorder final : public Accelerator<float> {
 public:
  Recorder(const Accelerator<float>& real, Calls& camera, Calls& shadow)
      : real_(real), camera_(camera), shadow_(shadow) {}
  AcceleratorFacts facts() const override { return real_.facts(); }
  void closest(const RayBatch<float>& rays, const LaneGroups& groups, HitBatch<float>& hits,
               AcceleratorCounts& counts) const override {
    camera_.push_back(call_of(rays, groups));
    real_.closest(rays, groups, hits, counts);
  }
  void occlude(RayBatch<float>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    shadow_.push_back(call_of(rays, groups));
    real_.occlude(rays, groups, counts);
  }

 private:
  const Accelerator<float>& real_;
  Calls &camera_, &shadow_;
};

std::uint64_t rays_of(const Calls& calls) {
  std::uint64_t rays = 0;
  for (const auto& call : calls) rays += active_rays(call->rays, call->groups);
  return rays;
}

// Returns full batches of rays in random directions from the hits of the camera rays. If `scattered`, the
// rays are in random order.
Calls bounced(const Calls& camera, const Accelerator<float>& accelerator, bool scattered) {
  test::Random random(1);
  std::vector<Ray<float>> rays;
  for (const auto& call : camera) {
    HitBatch<float> hits = call->hits;
    AcceleratorCounts counts;
    accelerator.closest(call->rays, call->groups, hits, counts);
    for (const int first : call->groups)
      for (int i = first; i < first + kWidth<float>; ++i) {
        if (hits.primitive[i] == kNoPrimitive) continue;
        rays.push_back({call->rays[i].at(0.999f * hits.t[i]), Vec3f(random.direction())});
      }
  }
  if (scattered)
    for (std::size_t i = rays.size(); i > 1; --i)
      std::swap(rays[i - 1], rays[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  Calls calls;
  const auto batch = std::make_unique<RayBatch<float>>();
  for (std::size_t from = 0; from + kBatch <= rays.size(); from += kBatch) {
    for (int i = 0; i < kBatch; ++i)
      batch->set(i, rays[from + static_cast<std::size_t>(i)], std::numeric_limits<float>::infinity());
    batch->count = kBatch;
    calls.push_back(call_of(*batch, LaneGroups::covering(0, kBatch, kWidth<float>)));
  }
  return calls;
}

// Traces copies of all calls and returns the CPU seconds. Adds to `counts` and `occluded`.
double trace_calls(const Accelerator<float>& accelerator, const Calls& calls, bool shadows,
                   AcceleratorCounts& counts, std::uint64_t& occluded) {
  const auto rays = std::make_unique<RayBatch<float>>();
  const auto hits = std::make_unique<HitBatch<float>>();
  double seconds = 0;
  for (const auto& call : calls) {
    *rays = call->rays;
    *hits = call->hits;
    const double start = thread_seconds();
    if (shadows)
      accelerator.occlude(*rays, call->groups, counts);
    else
      accelerator.closest(*rays, call->groups, *hits, counts);
    seconds += thread_seconds() - start;
    if (shadows) occluded += active_rays(call->rays, call->groups) - active_rays(*rays, call->groups);
  }
  return seconds;
}

// Arguments of the program.
struct Task {
  std::string scene, structure, stage, what;
};

struct Sides {
  Calls ours, theirs;  // rays of each side; an empty `ours` means the rays of `theirs`
  std::shared_ptr<const Accelerator<float>> with, without;
  bool shadows = false;
  double build_ms = 0;
};

Sides sides_of(const PreparedScene& scene, const Task& task) {
  RenderRequest request;
  request.precision = Precision::single_precision;
  request.accelerator = task.structure;
  if (task.stage == "predict")
    for (std::size_t i = 0; i < kPredictions.size(); ++i)
      if (kPredictions[i] == task.what) request.prediction = static_cast<Prediction>(i);
  Plan plan = make_plan(scene.scene(), request);
  Sides sides;
  double structure_ms = 0;
  const World<float> bare = world_for<float>(scene.parts(), *plan.accelerator, plan.time, structure_ms);
  sides.without = bare.accelerator;
  sides.with = staged_world<float>(scene.parts(), settle(scene, plan), sides.build_ms).accelerator;
  Calls camera, shadow;
  if (task.stage != "predict") plan.max_depth = 0;
  try_tiles<float>({bare.geometry, std::make_shared<const Recorder>(*bare.accelerator, camera, shadow)}, plan,
                   kTiles);
  sides.shadows = task.stage == "predict";
  sides.theirs = std::move(sides.shadows ? shadow : camera);
  if (task.stage == "known") {
    for (const auto& call : sides.theirs) {
      sides.ours.push_back(std::make_unique<Call>(*call));
      AcceleratorCounts counts;
      bare.accelerator->closest(call->rays, call->groups, sides.ours.back()->hits, counts);
    }
  } else if (task.stage == "reorder") {
    sides.with = reordered(sides.without);
    if (task.what != "camera")
      sides.theirs = bounced(sides.theirs, *bare.accelerator, task.what == "scattered");
  }
  return sides;
}

int run(const Task& task) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const PreparedScene scene(load_scene_at(task.scene));
  const Sides sides = sides_of(scene, task);
  const Calls& ours = sides.ours.empty() ? sides.theirs : sides.ours;
  AcceleratorCounts with, without;
  std::uint64_t occluded = 0, again = 0;
  trace_calls(*sides.with, ours, sides.shadows, with, occluded);
  const double once = trace_calls(*sides.without, sides.theirs, sides.shadows, without, again);
  if (occluded != again) throw std::runtime_error("occluded rays must be the same with the stage");
  const int repeats = std::max(1, static_cast<int>(kMinRunSeconds / once));
  std::printf("%s\n", ordered_json({{"rays", rays_of(sides.theirs)},
                                    {"ray_s", once / static_cast<double>(rays_of(sides.theirs))},
                                    {"occluded", occluded},
                                    {"proposals", with.predicted_occluders},
                                    {"proofs", with.verified_occluders},
                                    {"build_ms", sides.build_ms}})
                          .dump()
                          .c_str());
  std::fflush(stdout);
  serve_runs(repeats, [&](bool mine) {
    return trace_calls(mine ? *sides.with : *sides.without, mine ? ours : sides.theirs, sides.shadows, with,
                       again);
  });
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count != 5) return 2;
  try {
    return orrery::bench::run({words[1], words[2], words[3], words[4]});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stages: %s\n", error.what());
    return 1;
  }
}
