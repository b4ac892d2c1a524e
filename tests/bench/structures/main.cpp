#include <oneapi/tbb/global_control.h>
#include <time.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/accelerators/registry.h"
#include "core/load/load.h"
#include "core/plan/plan.h"
#include "core/render/trial.h"
#include "server/commands/mesh_files.h"

// Every structure on one scene: what building it takes, and what the rays of some tiles of its picture cost
// in it, on one thread.
//   structures SCENE.json ROUNDS
// Prints JSON. Times are CPU time; each round asks every structure once, so that their ratios hold while the
// machine's speed drifts.
namespace orrery::bench {
namespace {

using nlohmann::ordered_json;

constexpr int kTiles = 12;
constexpr double kPatience = 2;  // CPU seconds that building again may take

double thread_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return double(used.tv_sec) + double(used.tv_nsec) * 1e-9;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Times what it passes on.
template <class T>
class Stopwatch final : public Accelerator<T> {
 public:
  explicit Stopwatch(std::shared_ptr<const Accelerator<T>> real) : real_(std::move(real)) {}
  AcceleratorFacts facts() const override { return real_->facts(); }
  void closest(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    const double start = thread_seconds();
    real_->closest(rays, groups, hits, counts);
    seconds_ += thread_seconds() - start;
  }
  void occlude(RayBatch<T>& rays, const Groups& groups, AcceleratorCounts& counts) const override {
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
  TraceCounts counts;  // of one round
};

// Structures without a hierarchy would take minutes.
bool too_slow(const AcceleratorType& type, int primitives) {
  const std::string_view name = type.name;
  return primitives > 20'000 && (name == "list" || name == "boxes" || name == "oriented-boxes");
}

template <class T>
Candidate<T> candidate_of(const AcceleratorType& type, const std::shared_ptr<const Geometry<T>>& geometry,
                          int rounds) {
  Candidate<T> candidate{&type, {geometry, nullptr}, nullptr, {}, {}, {}};
  std::shared_ptr<const Accelerator<T>> built;
  double spent = 0;
  for (int i = 0; i < rounds && spent < kPatience; ++i) {
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

template <class T>
ordered_json measure(const std::shared_ptr<const Scene>& scene, const Plan& plan, int rounds) {
  const auto geometry = make_geometry<T>(scene);
  std::vector<Candidate<T>> candidates;
  for (const auto& type : accelerator_types()) {
    if (too_slow(type, scene->primitive_count())) continue;
    std::fprintf(stderr, "  building %s\n", type.name);
    candidates.push_back(candidate_of(type, geometry, rounds));
  }
  for (int round = 0; round < rounds; ++round) {
    std::fprintf(stderr, "  round %d of %d\n", round + 1, rounds);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      auto& candidate = candidates[round % 2 == 0 ? i : candidates.size() - 1 - i];
      candidate.counts = try_tiles(candidate.world, plan, kTiles);
      candidate.trace_s.push_back(candidate.stopwatch->take());
    }
  }
  ordered_json list = ordered_json::array();
  for (const auto& candidate : candidates) {
    const AcceleratorCounts& counts = candidate.counts.accelerator;
    const AcceleratorFacts facts = candidate.world.accelerator->facts();
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

int run(const std::string& path, int rounds) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto scene = load_scene(text, MeshFiles(std::filesystem::path(path).parent_path()));
  const Plan plan = make_plan(*scene, {});
  const ordered_json structures =
      plan.double_precision ? measure<double>(scene, plan, rounds) : measure<float>(scene, plan, rounds);
  std::printf("%s\n", ordered_json({{"primitives", scene->primitive_count()},
                                    {"precision", plan.double_precision ? "double" : "float"},
                                    {"auto", plan.accelerator->name},
                                    {"structures", structures}})
                          .dump()
                          .c_str());
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count != 3) return 2;
  try {
    return orrery::bench::run(words[1], std::max(1, std::atoi(words[2])));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "structures: %s\n", error.what());
    return 1;
  }
}
