#include "core/study/audit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/accuracy/unit_histogram.h"
#include "core/image/srgb.h"
#include "core/model/technique.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"

namespace orrery {
namespace {

// Samples per pixel of the render without cuts, if the request has one sample at the pixel centre.
constexpr int kSamplesOfMiddle = 64;
// Maximum min_contribution of the render without cuts, for techniques that trace ray trees.
constexpr double kMinWeight = 1e-4;

// Returns the numbers of `count` random pixels, drawn with replacement. Pixels are numbered row by row.
std::vector<std::int64_t> draw_pixels(const Plan& plan, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double all = double(plan.width) * plan.height;
  std::vector<std::int64_t> drawn;
  for (int i = 0; i < count; ++i)
    drawn.push_back(static_cast<std::int64_t>(std::ldexp(static_cast<double>(random() >> 11), -53) * all));
  return drawn;
}

// Returns one tile of a single pixel for each distinct pixel.
std::vector<TileView> tiles_of(std::vector<std::int64_t> pixels, int width, int samples) {
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  std::vector<TileView> tiles;
  for (const std::int64_t pixel : pixels)
    tiles.push_back({.x0 = static_cast<int>(pixel % width),
                     .y0 = static_cast<int>(pixel / width),
                     .width = 1,
                     .height = 1,
                     .samples = samples});
  return tiles;
}

RenderRequest without_cuts(const Plan& plan) {
  RenderRequest whole;
  static_cast<RenderSettings&>(whole) = settings_of(plan);
  whole.full_model = true;
  whole.precision = Precision::double_precision;
  whole.max_depth = kMaxDepth;
  whole.min_contribution = plan.technique->draws_light ? 0 : std::min(plan.min_contribution, kMinWeight);
  whole.clamp_indirect = 0;
  if (plan.samples == 1 && !plan.technique->draws_light) whole.samples = kSamplesOfMiddle;
  return whole;
}

// Renders `pixels` and adds the cost to `stats`. Returns a film whose other pixels are not set.
Film render_pixels(const PreparedScene& scene, const Plan& plan, const std::vector<std::int64_t>& pixels,
                   RenderStats& stats, Executor& executor, const RenderControl& control) {
  const SettledPlan settled = settle(scene, plan, control.stop);
  const auto prepared = threads_backend(executor)->prepare(scene, settled, stats, control.stop);
  Film film(plan.width, plan.height, FilmStorage::linear32);
  prepared->render(tiles_of(pixels, plan.width, plan.samples), film, stats, control);
  return film;
}

double in_space(double linear, Space space) {
  return space == Space::display ? encode_srgb(std::clamp(linear, 0.0, 1.0)) : linear;
}

}  // namespace

Audit audit(const PreparedScene& scene, const RenderRequest& asked, int pixels, std::uint64_t seed,
            Executor& executor, const RenderControl& control) {
  require_no_budget(asked, "an audit");
  require_picture(asked, "an audit");
  if (asked.layers && !asked.layers->empty())
    throw InputError("/render/layers", "cannot be used with an audit (an audit has no layers)");
  RenderRequest alone = asked;
  alone.reuse = 1;
  const Plan plan = make_plan(scene.scene(), alone);
  const Plan whole = make_plan(scene.scene(), without_cuts(plan));
  const std::vector<std::int64_t> drawn = draw_pixels(plan, pixels, seed);
  RenderStats cut_stats, whole_stats;
  const Film cut = render_pixels(scene, plan, drawn, cut_stats, executor, control);
  const Film full = render_pixels(scene, whole, drawn, whole_stats, executor, control);

  Audit found{.pixels = pixels, .left_out = whole_stats.omitted.max()};
  const double range = plan.halves_range(), left_out = in_space(found.left_out, plan.space);
  UnitHistogram shares;
  double squares = 0;
  for (const std::int64_t pixel : drawn) {
    const int x = static_cast<int>(pixel % plan.width), y = static_cast<int>(pixel / plan.width);
    const Vec3f a = cut.stored().linear(x, y), b = full.stored().linear(x, y);
    double most = 0, sum = 0, share = 0;
    bool is_equal = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = std::fabs(in_space(a[c], plan.space) - in_space(b[c], plan.space));
      most = std::max(most, off);
      is_equal = is_equal && off <= kEqualPixels;  // NaN counts as different
      sum += off * off;
      share += std::pow(std::min(1.0, (off + left_out) / range), 2) / 3;
    }
    found.differing += !is_equal;
    found.max = std::max(found.max, most);
    squares += sum;
    shares.add(std::isfinite(share) ? share : 1);
  }
  found.rms = std::sqrt(squares / (3.0 * pixels));
  if (std::isfinite(range))
    found.bound = Bound::audited(range * std::sqrt(shares.upper_mean(Certificate::kAlpha)));
  return found;
}

}  // namespace orrery
