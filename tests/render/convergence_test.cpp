// Tests that renders converge without bias. The mean squared error of an image with n samples is a / n + b^2,
// where b is the bias.
#include <gtest/gtest.h>

#include <cmath>

#include "core/render/progressive.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

namespace orrery {
namespace {

using test::covers;
using test::Json;

// Returns the mean squared errors after 8, 16, ... 512 samples. The two references are independent, so that
// their own errors cancel on average.
std::vector<double> errors_of(const std::shared_ptr<const Scene>& scene, RenderRequest r,
                              const std::array<std::vector<double>, 2>& truth) {
  r.samples = 512;
  const PreparedScene prepared(scene);
  ProgressiveRender render(prepared, settle(prepared, make_plan(*scene, r)), test::shared_executor(), {});
  std::vector<double> errors;
  for (int n = 8; n <= *r.samples; n *= 2) {
    render.refine(n);
    const std::vector<double> values = test::linear_values(render.film());
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += (values[i] - truth[0][i]) * (values[i] - truth[1][i]);
    errors.push_back(sum / static_cast<double>(values.size()));
  }
  return errors;
}

// Returns b^2, fitted with equal relative weights: the slope of n times the error as a function of n.
double squared_bias(const std::vector<double>& errors) {
  double sum_n = 0, sum_y = 0, sum_nn = 0, sum_ny = 0, n = 8;
  for (const double error : errors) {
    const double y = n * error;
    sum_n += n;
    sum_y += y;
    sum_nn += n * n;
    sum_ny += n * y;
    n *= 2;
  }
  const auto count = static_cast<double>(errors.size());
  return (count * sum_ny - sum_n * sum_y) / (count * sum_nn - sum_n * sum_n);
}

// Returns the mean of b^2 over seeds, in units of its standard error. The errors of stratified samples
// decrease faster than 1 / n, which makes b^2 negative.
double bias_in_standard_errors(const Json& json, const RenderRequest& r, const RenderRequest& unbiased) {
  constexpr int kSeeds = 8;
  const auto scene = test::load(json);
  std::array<std::vector<double>, 2> truth;
  for (std::uint64_t i = 0; i < 2; ++i) {
    RenderRequest much = unbiased;
    much.samples = 2048;
    much.seed = 1000 + i;
    truth[i] = test::linear_values(test::rendered(scene, much).film);
  }
  double sum = 0, squares = 0;
  RenderRequest seeded = r;
  for (seeded.seed = 0; *seeded.seed < kSeeds; ++*seeded.seed) {
    const double found = squared_bias(errors_of(scene, seeded, truth));
    sum += found;
    squares += found * found;
  }
  const double mean = sum / kSeeds;
  return mean / std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
}

TEST(Convergence, HasNoSignificantBiasInUnclampedModes) {
  covers("light-55");
  struct Mode {
    const char* name;
    const char* scene;
    void (*set)(RenderRequest&);
  };
  const Mode modes[] = {
      {"reuse", "cornell-box", [](RenderRequest&) {}},
      {"no reuse", "cornell-box", [](RenderRequest& r) { r.reuse = 1; }},
      {"distributed", "technique-distributed", [](RenderRequest&) {}},
      {"whitted", "glass", [](RenderRequest&) {}},
      {"lens", "depth-of-field", [](RenderRequest&) {}},
      {"shutter", "open-shutter", [](RenderRequest&) {}},
      {"negative lobes", "cornell-box", [](RenderRequest& r) { r.filter = Filter::mitchell; }},
  };
  for (const Mode& mode : modes) {
    RenderRequest r = test::size(16, 16);
    mode.set(r);
    EXPECT_LE(bias_in_standard_errors(test::sample(mode.scene), r, r), 3) << mode.name;
  }
}

TEST(Convergence, DetectsBiasOfClamp) {
  RenderRequest unbiased = test::size(16, 16), clamped = unbiased;
  clamped.clamp_indirect = 0.1;
  EXPECT_GT(bias_in_standard_errors(test::sample("cornell-box"), clamped, unbiased), 3);
}

}  // namespace
}  // namespace orrery
