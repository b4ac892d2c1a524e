#include <oneapi/tbb/global_control.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/accelerators/registry.h"
#include "core/budget/renderer.h"
#include "core/plan/plan.h"
#include "core/prepare/geometry.h"
#include "core/prepare/trial.h"
#include "tests/bench/measuring.h"
#include "tests/support/batches.h"
#include "tests/support/random.h"

// Measures build time and ray cost of every structure on one scene, on one thread. Traces the rays of some
// tiles of the image, or random rays through the bounded primitives.
//   structures SCENE.json ROUNDS picture|random [NAME...]
// Prints JSON. Times are CPU time. Each round measures every structure once, so that drift of the machine's
// speed does not affect ratios.
namespace orrery::bench {
namespace {

using nlohmann::ordered_json;

constexpr int kTiles = 12;
constexpr double kMaxBuildSeconds = 2;  // limit of CPU seconds for repetitions of a build

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Accelerator decorator that measures the CPU time of queries.
template <class T>
class Stopwatch final : public Accelerator<T> {
 public:
  explicit Stopwatch(std::shared_ptr<const Accelerator<T>> real) : real_(std::move(real)) {}
  AcceleratorFacts facts() const override { return real_->facts(); }
  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    const double start = thread_seconds();
    real_->closest(rays, groups, hits, counts);
    seconds_ += thread_seconds() - start;
  }
  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const double start = thread_seconds();
    real_->occlude(rays, groups, counts);
    seconds_ += thread_seconds() - start;
  }
  double take() const { return std::exchange(seconds_, 0.0); }

 private:
  std::shared_ptr<const Accelerator<T>> real_;
  mutable double seconds_ = 0;
};

template <class T>
struct Candidate {
  const AcceleratorType* type;
  World<T> world;
  std::shared_ptr<const Stopwatch<T>> stopwatch;
  std::vector<double> build_s, trace_s;
  TraceCounts counts;  // from the last round
};

// Returns true for structures without a hierarchy on many primitives, because measuring them would take
// minutes.
bool too_slow(const AcceleratorType& type, int primitives) {
  const std::string_view name = type.name;
  return primitives > 20'000 && (name == "list" || name == "boxes" || name == "oriented-boxes");
}

template <class T>
Candidate<T> candidate_of(const AcceleratorType& type, const std::shared_ptr<const Scene>& scene,
                          int rounds) {
  const auto geometry = make_geometry<T>(scene, type);
  Candidate<T> candidate{&type, {geometry, nullptr}, nullptr, {}, {}, {}};
  std::shared_ptr<const Accelerator<T>> built;
  double spent = 0;
  for (int i = 0; i < rounds && spent < kMaxBuildSeconds; ++i) {
    built.reset();
    const double start = thread_seconds();
    built = build(type, geometry->primitives);
    candidate.build_s.push_back(thread_seconds() - start);
    spent += candidate.build_s.back();
  }
  candidate.stopwatch = std::make_shared<const Stopwatch<T>>(built);
  candidate.world.accelerator = candidate.stopwatch;
  return candidate;
}

// Returns batches of rays between random points on the sphere around the bounded primitives.
template <class T>
std::vector<RayBatch<T>> random_rays(const PrimitiveList<T>& primitives) {
  Boundsd box;
  for (const auto& primitive : primitives)
    if (primitive.bounds.bounded()) box.include(primitive.bounds);
  const Vec3d middle = (box.lo + box.hi) * 0.5;
  test::Random random(1);
  std::vector<RayBatch<T>> batches(kTiles);
  std::vector<Ray<T>> rays(kBatch);
  for (auto& batch : batches) {
    for (auto& ray : rays) {
      const Vec3d from = middle + random.direction() * (box.diagonal() / 2);
      const Vec3d to = middle + random.direction() * (box.diagonal() / 2);
      ray = {Vec3<T>(from), Vec3<T>(safe_normalize(to - from))};
    }
    test::fill_batch<T>(rays, std::numeric_limits<T>::infinity(), batch);
  }
  return batches;
}

template <class T>
TraceCounts try_batches(const World<T>& world, const std::vector<RayBatch<T>>& batches) {
  TraceCounts counts;
  const auto hits = std::make_unique<HitBatch<T>>();
  for (const auto& batch : batches) {
    hits->t = batch.t_max;
    hits->primitive.values.fill(kNoPrimitive);
    world.accelerator->closest(batch, test::groups_of(batch), *hits, counts.accelerator);
    counts.rays.camera += static_cast<std::uint64_t>(batch.count);
  }
  return counts;
}

template <class T>
ordered_json measure(const std::shared_ptr<const Scene>& scene, const Plan& plan, int rounds, bool random,
                     const std::vector<std::string>& names) {
  std::vector<Candidate<T>> candidates;
  for (const auto& type : accelerator_types()) {
    const bool chosen = std::find(names.begin(), names.end(), type.name) != names.end();
    if (names.empty() ? too_slow(type, scene->primitive_count()) : !chosen) continue;
    std::fprintf(stderr, "  building %s\n", type.name);
    candidates.push_back(candidate_of<T>(type, scene, rounds));
  }
  std::vector<RayBatch<T>> batches;
  if (random) batches = random_rays(candidates.front().world.geometry->primitives);
  for (int round = 0; round < rounds; ++round) {
    std::fprintf(stderr, "  round %d of %d\n", round + 1, rounds);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      auto& candidate = candidates[round % 2 == 0 ? i : candidates.size() - 1 - i];
      candidate.counts =
          random ? try_batches(candidate.world, batches) : try_tiles(candidate.world, plan, kTiles);
      candidate.trace_s.push_back(candidate.stopwatch->take());
    }
  }
  ordered_json list = ordered_json::array();
  for (const auto& candidate : candidates) {
    const AcceleratorCounts& counts = candidate.counts.accelerator;
    const AcceleratorFacts facts = facts_of(candidate.world);
    const auto rays = static_cast<double>(candidate.counts.rays.total());
    list.push_back({{"name", candidate.type->name},
                    {"build_s", median(candidate.build_s)},
                    {"ray_s", median(candidate.trace_s) / rays},
                    {"visits", static_cast<double>(counts.node_visits) / rays},
                    {"boxes", static_cast<double>(counts.box_tests) / rays},
                    {"primitives", static_cast<double>(counts.primitive_tests) / rays},
                    {"counted_cost", candidate.type->costs.of(candidate.counts.rays.total(), counts) / rays},
                    {"bytes", facts.bytes},
                    {"depth", facts.depth},
                    {"references", facts.references}});
  }
  return list;
}

int run(const std::string& path, int rounds, bool random, const std::vector<std::string>& names) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const auto scene = load_scene_at(path);
  const SettledPlan plan = settle(PreparedScene(scene), make_plan(*scene, {}));
  const ordered_json structures = plan->double_precision
                                      ? measure<double>(scene, *plan, rounds, random, names)
                                      : measure<float>(scene, *plan, rounds, random, names);
  std::printf("%s\n", ordered_json({{"primitives", scene->primitive_count()},
                                    {"precision", plan->double_precision ? "double" : "float"},
                                    {"auto", plan->accelerator->name},
                                    {"structures", structures}})
                          .dump()
                          .c_str());
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count < 4) return 2;
  try {
    return orrery::bench::run(words[1], std::max(1, std::atoi(words[2])),
                              std::string_view(words[3]) == "random", {words + 4, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "structures: %s\n", error.what());
    return 1;
  }
}
