#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests the transmittance of glass with closed forms, furnaces, and limited depths.
namespace orrery::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

RenderRequest depth(int max_depth) {
  RenderRequest request;
  request.max_depth = max_depth;
  return request;
}

// Returns a slab of glass between z = -1/2 and 1/2. The sky is 1 below and 0 above, due to a black plane.
Json slab(double filter = 1) {
  return scene_with(
      json(R"([{'type': 'box', 'min': [-90, -90, -0.5], 'max': [90, 90, 0.5], 'material': 'glass'},
                             {'type': 'plane', 'point': [0, 0, 9], 'normal': [0, 0, -1], 'material': 'black'}])"),
      Json{{"materials",
            {{"glass",
              {{"type", "refractive"},
               {"ior", 1.5},
               {"fresnel", "exact"},
               {"filter", {filter, filter, filter}}}},
             {"black", {{"type", "rough"}, {"kd", 0}}}}},
           {"background", {1, 1, 1}}});
}
Ray<double> slanted(double degrees) {
  const Vec3d direction(std::sin(degrees * kRadians), 0, -std::cos(degrees * kRadians));
  return {Vec3d(0, 0, 0.5) - direction, direction};
}
// Returns the same slab with black below and the sky above, to show reflected light.
Json slab_from_below(double filter = 1) {
  Json scene = slab(filter);
  scene["objects"][1]["point"] = {0, 0, -9};
  return scene;
}

TEST(Slab, MatchesTransmittanceSeries) {
  covers("R16");
  EXPECT_NEAR(Tracing(slab(), depth(32)).trace(slanted(0)).radiance.x, .92307692307692, 1e-12);
  EXPECT_NEAR(Tracing(slab_from_below(), depth(32)).trace(slanted(0)).radiance.x, .07692307692308, 1e-12);
}

TEST(Slab, TransmitsLessAtSlantedAngles) {
  covers("R17 D10");
  Tracing tracing(slab(), depth(32));
  EXPECT_NEAR(tracing.trace(slanted(45)).radiance.x, .90432679, 5e-9);
  EXPECT_NEAR(tracing.trace(slanted(60)).radiance.x, .83623246, 5e-9) << "unpolarized light at each surface";
  EXPECT_NEAR(tracing.trace(slanted(80)).radiance.x, .44122917, 5e-9);
}

TEST(Slab, AbsorbsOnEveryPass) {
  covers("R16");
  const double half = std::exp(-0.5);
  EXPECT_NEAR(Tracing(slab(half), depth(32)).trace(slanted(0)).radiance.x, .55930787, 5e-9);
  EXPECT_NEAR(Tracing(slab_from_below(half), depth(32)).trace(slanted(0)).radiance.x, .05356949, 5e-9);
}

// Traces 0, 1 and 2 round trips inside the slab. The ledger bounds the error.
TEST(Slab, BoundsTruncationErrorByLedger) {
  covers("D9");
  const double expected[] = {.9216, .92307456, .9230769193};
  for (int trips = 0; trips < 3; ++trips) {
    const TraceOutput answer = Tracing(slab(), depth(2 + 2 * trips)).trace(slanted(0));
    EXPECT_NEAR(answer.radiance.x, expected[trips], 5e-10);
    EXPECT_GT(answer.cut, 0);
    EXPECT_LE(12.0 / 13 - answer.radiance.x, answer.cut);
  }
}

TEST(Ball, AttenuatesByChord) {
  covers("R24");
  const double sigma = .5;
  Json scene = scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'fog'}]"),
                          Json{{"materials",
                                {{"fog",
                                  {{"type", "refractive"},
                                   {"ior", 1},
                                   {"fresnel", "exact"},
                                   {"filter", {std::exp(-sigma), 1, std::exp(-2 * sigma)}}}}}},
                               {"background", {1, 1, 1}}});
  Tracing tracing(scene, depth(5));
  const Vec3d centre = tracing.trace(Ray<double>{{0, 0, 5}, {0, 0, -1}}).radiance;
  EXPECT_NEAR(centre.x, .36787944117144, 1e-12);
  EXPECT_NEAR(centre.y, 1, 1e-12);
  EXPECT_NEAR(centre.z, std::exp(-4 * sigma), 1e-12);
  EXPECT_NEAR(tracing.trace(Ray<double>{{.6, 0, 5}, {0, 0, -1}}).radiance.x, std::exp(-2 * sigma * .8),
              1e-12);
}

// Glass of any closed shape that absorbs no light is invisible under a uniform sky of radiance 1.
TEST(Furnace, HidesGlassUnderUniformSky) {
  covers("R3 D11");
  for (const char* object : {"{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}",
                             "{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 1]}",
                             "{'type': 'cylinder', 'base': [0, -1, 0], 'top': [0, 1, 0], 'radius': 0.7}"})
    for (const char* fresnel : {"schlick", "exact"})
      for (const double ior : {1.1, 1.5, 2.417, 0.7}) {
        const Json materials{
            {"white", {{"type", "refractive"}, {"kd", nullptr}, {"ior", ior}, {"fresnel", fresnel}}}};
        const Json scene =
            scene_with(json(object), Json{{"materials", materials}, {"background", {1, 1, 1}}});
        Json lit = scene;
        lit["ambient"] = {1, 1, 1};  // replaces omitted rays
        RenderRequest request = depth(12);
        request.min_contribution = 1e-4;
        Tracing dark(scene, request), even(lit, request);
        Random random(1);
        std::vector<Ray<double>> rays;
        for (int i = 0; i < 100; ++i) {
          const Vec3d direction = random.direction();
          rays.push_back({random.in_cube(0.9) - direction * 5, direction});
        }
        for (const TraceOutput& answer : dark.trace(rays))
          EXPECT_NEAR(answer.radiance.x + answer.cut, 1, 1e-12) << object << ior;
        for (const TraceOutput& answer : even.trace(rays))
          EXPECT_NEAR(answer.radiance.x, 1, 1e-12) << object << ior;
      }
}

// With limited depth, the mean radiance over the disc of a ball is 7.3 % too low without internal
// reflections, 1.15 % with one reflection and .081 % with four reflections. The ledger equals this error.
TEST(Furnace, MatchesErrorOfLimitedDepth) {
  covers("D11");
  const Json scene = scene_of(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]",
      R"({'background': [1, 1, 1], 'materials': {'white': {'type': 'refractive', 'kd': null, 'ior': 1.5, 'fresnel': 'exact'}}})");
  const auto shortfall = [&](int internal_reflections) {
    Tracing tracing(scene, depth(internal_reflections + 2));
    std::vector<Ray<double>> rays;
    for (int i = 0; i < kBatch; ++i)  // rings of equal area
      rays.push_back({{std::sqrt((i + 0.5) / kBatch), 0, 5}, {0, 0, -1}});
    double sum = 0;
    for (const TraceOutput& answer : tracing.trace(rays)) {
      EXPECT_NEAR(answer.radiance.x + answer.cut, 1, 1e-12);
      sum += 1 - answer.radiance.x;
    }
    return sum / kBatch;
  };
  EXPECT_NEAR(shortfall(0), .073, 5e-4);
  EXPECT_NEAR(shortfall(1), .0115, 5e-5);
  EXPECT_NEAR(shortfall(4), .00081, 5e-6);
}

}  // namespace
}  // namespace orrery::test
