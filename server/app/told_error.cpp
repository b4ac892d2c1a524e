#include "server/app/told_error.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace orrery {

using nlohmann::ordered_json;

ordered_json error_json(const RenderStats& stats) {
  const SampledError& error = stats.error;
  const auto [low, high] = error.interval();
  return {{"rmse", error.pixel.rmse()},
          {"rmse_low", low},
          {"rmse_high", std::isfinite(high) ? ordered_json(high) : ordered_json(nullptr)},
          {"rmse_4", error.block4.rmse()},
          {"rmse_32", error.block32.rmse()},
          {"samples", error.samples},
          {"rays", stats.counts.rays.total()}};
}

std::string error_text(const RenderStats& stats) {
  const SampledError& error = stats.error;
  const auto [low, high] = error.interval();
  char text[256];
  std::snprintf(text, sizeof text, "%.4g; low=%.4g; high=%.4g; of-4=%.3g; of-32=%.3g; samples=%d; rays=%llu",
                error.pixel.rmse(), low, high, error.block4.rmse(), error.block32.rmse(), error.samples,
                static_cast<unsigned long long>(stats.counts.rays.total()));
  return text;
}

}  // namespace orrery
