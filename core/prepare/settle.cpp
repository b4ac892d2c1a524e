#include "core/prepare/settle.h"

#include <algorithm>
#include <cstdio>

#include "core/accelerators/registry.h"
#include "core/base/clock.h"
#include "core/prepare/trial.h"

namespace orrery {
namespace {

constexpr int kTiles = 3, kDeepest = 3;                 // number of tiles and maximum ray depth of a trial
constexpr int kListMayPay = 64, kBoxesMayPay = 10'000;  // primitive counts up to which each is tried
constexpr double kGain = 0.85;  // maximum cost of a replacement, relative to the planned accelerator

struct TrialResult {
  const AcceleratorType* type;
  double cost;  // ns per ray
};

template <class T>
TrialResult try_one(PreparedScene::Parts& parts, const AcceleratorType& type, const Plan& plan,
                    std::stop_token stop) {
  double build_ms = 0;
  const TraceCounts counts =
      try_tiles(world_for<T>(parts, type, plan.exposure(), build_ms, stop), plan, kTiles, stop);
  const std::uint64_t rays = counts.rays.total();
  return {&type, type.costs.of(rays, counts.accelerator) / static_cast<double>(rays)};
}

template <class T>
Decision choose(PreparedScene::Parts& parts, const Plan& plan, std::stop_token stop) {
  Plan shallow = plan;
  shallow.max_depth = std::min(plan.max_depth, kDeepest);
  std::vector<TrialResult> tried{try_one<T>(parts, *plan.accelerator, shallow, stop)};
  const auto primitives = parts.scene->primitive_count();
  for (const auto& type : accelerator_types()) {
    const std::string_view name = type.name;
    if ((name == "boxes" && primitives <= kBoxesMayPay) || (name == "list" && primitives <= kListMayPay))
      tried.push_back(try_one<T>(parts, type, shallow, stop));
  }
  const auto cheapest = std::min_element(
      tried.begin(), tried.end(), [](const TrialResult& a, const TrialResult& b) { return a.cost < b.cost; });
  const TrialResult& best = cheapest->cost < kGain * tried.front().cost ? *cheapest : tried.front();
  std::string reason = "estimated from operation counts on some tiles, in ns per ray:";
  for (const TrialResult& t : tried) {
    char text[80];
    std::snprintf(text, sizeof text, "%s %s %.3g", &t == &tried.front() ? "" : ",", t.type->name, t.cost);
    reason += text;
  }
  return {"accelerator", best.type->name, reason, {}};
}

}  // namespace

SettledPlan settle(const PreparedScene& scene, Plan plan, std::stop_token stop) {
  if (!plan.try_accelerators) return {std::move(plan), 0};
  plan.try_accelerators = false;
  PreparedScene::Parts& parts = scene.parts();
  double took_ms = 0;
  const auto decide = [&]<class T>(std::optional<Decision>& chosen, T) {
    const auto lock = lock_unless(parts.trying, stop);
    if (!chosen) {
      const auto start = Clock::now();
      chosen = choose<T>(parts, plan, stop);
      took_ms = milliseconds_since(start);
    }
    return *chosen;
  };
  const Decision decision = plan.double_precision ? decide(made_of<double>(parts).chosen, double())
                                                  : decide(made_of<float>(parts).chosen, float());
  for (const auto& type : accelerator_types())
    if (decision.choice == type.name) plan.accelerator = &type;
  for (Decision& made : plan.decisions)
    if (made.subject == decision.subject) made = decision;
  return {std::move(plan), took_ms};
}

}  // namespace orrery
