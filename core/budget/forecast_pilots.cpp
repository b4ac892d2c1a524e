#include "core/budget/forecast_pilots.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace orrery {
namespace {

constexpr int kSamples = 4, kSteps = 4, kTiles = 16;
constexpr double kColdMs = 50;            // CPU time below which cold caches distort the measured time
constexpr double kLargestExponent = 1.5;  // exponent_ of errors at edges

double rays_of(const Pilot& pilot) { return static_cast<double>(pilot.stats.counts.rays.total()); }

double mean_square(const RenderStats& stats) {
  const double rmse = stats.error.pixel.rmse();
  return stats.halves.known() ? stats.halves.mean() : rmse * rmse;
}

// Traces the tiles, and traces them again if this took less than kColdMs. The first tiles of a process are up
// to ten times slower.
Pilot warm_tiles(const PreparedScene& scene, const SettledPlan& plan, int samples, Executor& executor,
                 const RenderControl& control) {
  const Pilot first = trace_tiles(scene, plan, kTiles, samples, executor, control);
  if (first.stats.cpu_ms >= kColdMs) return first;
  Pilot second = trace_tiles(scene, plan, kTiles, samples, executor, control);
  second.stats.build_ms = first.stats.build_ms;  // the scene was prepared in the first run
  return second;
}

}  // namespace

// The blocks of trace_pilot() predict rays and errors, but neither path reuse nor time. Whole tiles predict
// path reuse and time.
ForecastPilots::ForecastPilots(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                               const RenderControl& control)
    : samples_(plan->samples == 1 ? 1 : kSamples),
      last_(warm_tiles(scene, plan, samples_, executor, control)),
      rays_per_sample_(rays_of(last_) / last_.share / samples_),
      cpu_s_per_ray_(last_.stats.cpu_ms / 1000 / rays_of(last_)),
      build_ms_(last_.stats.build_ms) {
  if (plan->reuse > 1) return;
  double after = 0;
  if (samples_ > 1) {
    go_on(trace_pilot(scene, plan, kSteps * samples_, executor, control));
    after = mean_square(last_.stats);
  }
  go_on(trace_pilot(scene, plan, samples_, executor, control));
  rays_per_sample_ = rays_of(last_) / last_.share / samples_;
  const double before = mean_square(last_.stats);
  if (before > 0 && after > 0)
    exponent_ = std::clamp(std::log(before / after) / std::log(kSteps), 1.0, kLargestExponent);
}

void ForecastPilots::go_on(const Pilot& next) {
  const RenderStats before = std::exchange(last_, next).stats;
  last_.stats.counts.cut_rays += before.counts.cut_rays;
  if (before.omitted.rms() > last_.stats.omitted.rms()) last_.stats.omitted = before.omitted;
}

RenderStats ForecastPilots::extrapolated(int samples) const {
  RenderStats stats = last_.stats;
  if (!stats.error.known() || samples % 2 != 0) {
    stats.error = {};
    stats.halves = {};
    return stats;
  }
  const double times = std::pow(double(samples_) / samples, exponent_);
  stats.error = stats.error.scaled(samples, times, 1 / last_.share);
  stats.halves = stats.halves.scaled(1 / last_.share, times);
  return stats;
}

}  // namespace orrery
