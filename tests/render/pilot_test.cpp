#include "core/budget/pilot.h"

#include <gtest/gtest.h>

#include "core/budget/renderer.h"
#include "core/plan/plan.h"
#include "tests/render/random_optics.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

namespace orrery::test {
namespace {

RenderRequest request(int side) {
  RenderRequest r;
  r.width = r.height = side;
  r.samples = 2;
  r.max_depth = 16;
  r.min_contribution = 0.01;
  return r;
}

struct Traced {
  RenderStats pilot, picture;
};
Traced traced(const Json& json, int side) {
  const auto scene = load(json);
  const PreparedScene prepared(scene);
  const SettledPlan plan = settle(prepared, make_plan(*scene, request(side)));
  return {trace_pilot(prepared, plan, 2, shared_executor(), {}).stats, rendered(scene, request(side)).stats};
}

// For random scenes, the pilot's ray count predicts the ray count of the image within 10 % in at least 95 of
// 100 scenes.
TEST(Pilot, PredictsRayCountOfImage) {
  covers("certificate-33");
  constexpr int kSide = 512;
  Random random(1);
  int near = 0;
  for (int i = 0; i < 100; ++i) {
    const auto [pilot, picture] = traced(random_optics(random), kSide);
    ASSERT_EQ(pilot.counts.rays.camera * 64, picture.counts.rays.camera);
    const double extrapolated = 64.0 * static_cast<double>(pilot.counts.rays.total());
    near += std::abs(extrapolated / static_cast<double>(picture.counts.rays.total()) - 1) <= 0.1;
  }
  EXPECT_GE(near, 95);
}

// Includes images smaller than a block, or with partial tiles.
TEST(Pilot, StaysWithinImage) {
  Random random(2);
  const Json scene = random_optics(random);
  for (const int side : {1, 3, 33, 50}) {
    const auto [pilot, picture] = traced(scene, side);
    EXPECT_GE(pilot.counts.rays.camera, 2u) << side;
    EXPECT_LE(pilot.counts.rays.camera, picture.counts.rays.camera) << side;
    EXPECT_LE(pilot.counts.rays.total(), picture.counts.rays.total()) << side;
  }
}

}  // namespace
}  // namespace orrery::test
