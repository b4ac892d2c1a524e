#include <gtest/gtest.h>

#include "core/budget/budget.h"
#include "tests/support/pictures.h"

// Tests renders that end for reasons other than a met error or time budget.
namespace orrery {
namespace {

using test::rendered;

RenderRequest square(int side, double error = 0) {
  RenderRequest r = test::size(side, side);
  if (error > 0) r.error = error;
  r.space = Space::display;
  return r;
}

// A smaller min_contribution adds no rays to a technique without secondary rays.
TEST(ErrorBudget, SkipsWeakRaySearchWithoutSecondaryRays) {
  const auto scene = test::load(test::sample("glass"));
  RenderRequest r = square(64, 0.1);
  r.technique = "raycast";
  EXPECT_EQ(rendered(scene, r).stats.counts.rays.camera,
            64u * 64 * *rendered(scene, r).budget->settings.samples);
}

// A render with fewer samples than requested misses the budget, even if its error is small enough.
TEST(ErrorBudget, IsMissedWithFewerSamplesThanRequested) {
  RenderRequest r = square(64, 0.9);
  r.samples = 1024;
  const RenderResult result = rendered(test::load(test::sample("paper")), r, {.max_rays = 1e6});
  EXPECT_LT(*result.budget->settings.samples, 1024);
  EXPECT_FALSE(result.budget->met());
  EXPECT_NE(result.budget->reason.find("(limit "), std::string::npos) << result.budget->reason;
}

}  // namespace
}  // namespace orrery
