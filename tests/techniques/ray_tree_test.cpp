#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Tests growth and termination of ray trees: by depth, by weight, and in the counters.
namespace orrery::test {
namespace {

RenderRequest limits(int max_depth, double min_contribution = 0) {
  RenderRequest request;
  request.max_depth = max_depth;
  request.min_contribution = min_contribution;
  return request;
}

// Returns the index of a dielectric with this reflectance at normal incidence.
double index_of(double reflectance) { return (1 + std::sqrt(reflectance)) / (1 - std::sqrt(reflectance)); }

// Returns two facing mirrors.
Json mirrors(double reflectance, double ambient) {
  const double n = reflectance == 1 ? 0 : index_of(reflectance);
  return scene_with(
      json("[{'type': 'plane', 'point': [0, 0, -5], 'normal': [0, 0, 1]}, {'type': 'plane', 'point': [0, 0, "
           "5], 'normal': [0, 0, -1]}]"),
      Json{{"ambient", {ambient, ambient, ambient}},
           {"background", {1, 1, 1}},  // not visible between the mirrors
           {"materials",
            {{"white", {{"type", "reflective"}, {"kd", nullptr}, {"n", {n, n, n}}, {"k", {0, 0, 0}}}}}}});
}
constexpr auto kUpright = [] { return Ray<double>{{0, 0, 0}, {0, 0, -1}}; };

// Returns `count` slabs of glass whose surfaces have reflectance `reflectance`. The sky is 1 below, and a
// black plane is above.
Json slabs(int count, double reflectance) {
  Json objects = json("[{'type': 'plane', 'point': [0, 0, 9], 'normal': [0, 0, -1], 'material': 'black'}]");
  for (int i = 0; i < count; ++i)
    objects.push_back(
        {{"type", "box"}, {"min", {-50, -50, -2 * i - 1}}, {"max", {50, 50, -2 * i}}, {"material", "glass"}});
  return scene_with(
      objects,
      Json{{"materials",
            {{"glass", {{"type", "refractive"}, {"ior", index_of(reflectance)}, {"fresnel", "exact"}}},
             {"black", {{"type", "rough"}, {"kd", 0}}}}},
           {"background", {1, 1, 1}}});
}
const Ray<double> kDown{{0, 0, 5}, {0, 0, -1}};

// At depth 5, mirrors of reflectance .9 omit .53 of the light. At depth 10, mirrors of .99 omit .90. The
// ledger contains this fraction, and ambient light replaces it.
TEST(DepthLimit, RecordsRemainingLightOfFacingMirrors) {
  covers("E1");
  for (const auto& [reflectance, depth] : {std::pair{.5, 5}, {.9, 5}, {.99, 10}, {.9, 32}}) {
    const double left = std::pow(reflectance, depth + 1);
    const TraceOutput answer = Tracing(mirrors(reflectance, 0.25), limits(depth)).trace(kUpright());
    EXPECT_NEAR(answer.cut, left, 1e-13);
    EXPECT_NEAR(answer.radiance.x, left * 0.25, 1e-13);
  }
  EXPECT_NEAR(Tracing(mirrors(.9, 0), limits(5)).trace(kUpright()).cut, .53, .005);
  EXPECT_NEAR(Tracing(mirrors(.99, 0), limits(10)).trace(kUpright()).cut, .90, .005);
}

// A room has glass walls that reflect `albedo` at normal incidence, under a sky of 1 / (1 - albedo). Each
// wall transmits radiance 1 into the room and reflects `albedo` of the light inside. After n walls, the
// radiance of a ray is (1 - albedo^n) / (1 - albedo). Together with the ledger, the sum is 1 / (1 - albedo).
TEST(ClosedRoom, SumsGeometricSeriesForRefractiveWalls) {
  covers("R2");
  const auto seen = [](double albedo, int walls) {
    const double sky = 1 / (1 - albedo);
    const Json room = scene_with(
        json("{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 1]}"),
        Json{{"materials",
              {{"white",
                {{"type", "refractive"}, {"kd", nullptr}, {"ior", index_of(albedo)}, {"fresnel", "exact"}}}}},
             {"background", {sky, sky, sky}}});
    const TraceOutput answer = Tracing(room, limits(walls)).trace(kUpright());
    EXPECT_NEAR(answer.radiance.x + answer.cut * sky, sky, 1e-12 * sky);
    return answer.radiance.x;
  };
  EXPECT_NEAR(seen(0.5, 32), 2, 1e-9);
  EXPECT_NEAR(seen(0.5, 4), 1.875, 1e-12);
  EXPECT_NEAR(seen(0.9, 9), 6.126, 5e-4);
  EXPECT_NEAR(seen(0.9, 32), (1 - std::pow(0.9, 32)) / 0.1, 1e-11);
}

TEST(DepthLimit, TerminatesForPerfectMirrorsAndReportsOmission) {
  covers("E4");
  const Picture picture = render(mirrors(1, 0), [] {
    RenderRequest r = limits(32);
    r.width = r.height = 32;
    return r;
  }());
  const RayCounts& rays = picture.stats.counts.rays;
  EXPECT_EQ(rays.camera, 1024u);
  for (std::size_t depth = 1; depth <= 32; ++depth) EXPECT_EQ(rays.reflected[depth], 1024u);
  EXPECT_EQ(rays.total(), 1024u * 33);
  EXPECT_EQ(picture.stats.counts.cut_rays, 1024u);
  EXPECT_NEAR(picture.stats.omitted.max(), 1, 1e-6);
  EXPECT_NEAR(picture.stats.omitted.rms(), 1, 1e-6);
  EXPECT_EQ(picture.stats.non_finite_pixels, 0u);
}

// With a threshold of 1/255, an evenly splitting tree ends at depth 8, where each branch has weight 1/256.
// The sum of the branches in the ledger bounds the error. Two slabs, with four surfaces of reflectance 1/2,
// transmit 1/5.
TEST(Threshold, SumsOmittedBranchesInLedger) {
  covers("E2");
  const TraceOutput coarse = Tracing(slabs(2, .5), limits(32, 1.0 / 255)).trace(kDown);
  EXPECT_GT(std::abs(coarse.radiance.x - .2), 1.0 / 255) << "each branch is small, but not their sum";
  EXPECT_LE(std::abs(coarse.radiance.x - .2), coarse.cut);
  const TraceOutput fine = Tracing(slabs(2, .5), limits(32, 1e-5)).trace(kDown);
  EXPECT_LE(std::abs(fine.radiance.x - .2), fine.cut);
  EXPECT_LT(fine.cut, coarse.cut / 5);
}

// Each surface of the slab reflects .9, so one branch has most of the weight. Without a threshold, only the
// depth limit causes an error.
TEST(Threshold, IsDisabledByDefault) {
  covers("E3");
  EXPECT_EQ(load(slabs(1, .9))->render.min_contribution, 0);
  const double exact = (1 - .9) / (1 + .9);
  const TraceOutput with = Tracing(slabs(1, .9), limits(32, 1.0 / 255)).trace(kDown);
  EXPECT_LE(std::abs(with.radiance.x - exact), with.cut);
  const TraceOutput without = Tracing(slabs(1, .9), limits(32)).trace(kDown);
  EXPECT_LE(std::abs(without.radiance.x - exact), without.cut);
  EXPECT_LE(without.cut, .1 * std::pow(.9, 30)) << "light left in the slab after 30 reflections";
  // Ambient light replaces the ray reflected by the sixth mirror of .9, which gives a radiance of .9^6.
  EXPECT_NEAR(Tracing(mirrors(.9, 1), limits(5)).trace(kUpright()).radiance.x, std::pow(.9, 6), 1e-4);
}

// A ray is traced if its weight is at least the threshold in some channel. The expected count follows from
// the series (1 - R) R^j of a slab.
TEST(Threshold, AppliesToEachRay) {
  constexpr double kR = .5;
  for (const double threshold : {0.4, 0.2, 0.1, 0.01, 0.0011}) {
    Tracing tracing(slabs(1, kR), limits(32, threshold));
    tracing.trace(kDown);
    std::uint64_t inside = 0, up_and_down = kR >= threshold;  // the ray reflected at the top has weight R
    for (int j = 0; j < 32; ++j) {
      if ((1 - kR) * std::pow(kR, j) < threshold) break;
      ++inside;
      up_and_down += (1 - kR) * std::pow(kR, j) * (1 - kR) >= threshold;
    }
    const RayCounts& rays = tracing.counts().rays;
    EXPECT_EQ(rays.total() - rays.camera, inside + up_and_down) << threshold;
  }
}

// If each surface spawns two rays, the tree at most doubles with each depth. The number of objects has no
// influence.
TEST(RayTree, GrowsWithBranchesButNotWithObjects) {
  Tracing tracing(slabs(3, .3), limits(10));
  tracing.trace(kDown);
  const RayCounts& rays = tracing.counts().rays;
  std::uint64_t last = 1;
  for (std::size_t depth = 1; depth <= 10; ++depth) {
    const std::uint64_t now = rays.reflected[depth] + rays.refracted[depth];
    EXPECT_LE(now, 2 * last) << depth;
    EXPECT_GT(now, 0u) << depth;
    last = now;
  }
  Json crowded = slabs(3, .3);
  for (int i = 0; i < 100; ++i)  // not hit by any ray
    crowded["objects"].push_back(
        {{"type", "sphere"}, {"center", {200 + 3 * i, 0, 0}}, {"radius", 1}, {"material", "black"}});
  Tracing among(crowded, limits(10));
  among.trace(kDown);
  EXPECT_EQ(among.counts().rays.total(), rays.total());
}

// Within the depth limit, no ray from the middle of the slabs leaves them, and every surface spawns two rays.
// There are 2^d rays at depth d.
TEST(RayTree, DoublesPerLevelInsideSlabs) {
  constexpr int kDepth = 10;
  Tracing tracing(slabs(24, .3), limits(kDepth));
  tracing.trace(Ray<double>{{0, 0, -23.5}, {0, 0, -1}});
  const RayCounts& rays = tracing.counts().rays;
  for (std::size_t depth = 1; depth <= kDepth; ++depth) {
    EXPECT_EQ(rays.reflected[depth], std::uint64_t{1} << (depth - 1)) << depth;
    EXPECT_EQ(rays.refracted[depth], std::uint64_t{1} << (depth - 1)) << depth;
  }
}

// The list tests every ray against every object exactly once.
TEST(RayTree, TestsEveryObjectPerRayWithList) {
  for (const int balls : {0, 1, 10, 100}) {
    Json scene = mirrors(.5, 1);
    for (int i = 0; i < balls; ++i)  // not hit by any ray
      scene["objects"].push_back(
          {{"type", "sphere"}, {"center", {200 + 3 * i, 0, 0}}, {"radius", 1}, {"material", "white"}});
    RenderRequest request = limits(5);
    request.accelerator = "list";
    Tracing tracing(scene, request);
    tracing.trace(kUpright());
    EXPECT_EQ(tracing.counts().rays.total(), 6u) << balls;
    EXPECT_EQ(tracing.counts().accelerator.primitive_tests, 6u * (2u + static_cast<unsigned>(balls)));
  }
}

// The number of rays for N x M pixels is (m + 1) d N M if each pixel takes d rays and each of these rays
// takes m shadow rays. Rough surfaces end the path, so d is 1 without mirrors. Mirrors have no direct light
// and take no shadow rays. Behind k mirrors, a pixel takes k + 1 rays and m shadow rays.
TEST(RayTree, MatchesRayCountFormula) {
  const auto counts = [](int mirrors_on_the_way, int lights) {
    Json scene = json(
        "{'version': 1, 'camera': {'type': 'orthographic', 'eye': [0, 0, 0], 'look_at': [0, 0, -1], "
        "'height': 1}}");
    scene["materials"] = json(
        "{'silver': {'type': 'reflective', 'n': [0.1, 0.1, 0.1], 'k': [4, 4, 4]}, 'paint': {'type': "
        "'rough'}}");
    // The mirrors form a periscope: each deflects the view by 90 degrees. A painted wall is at its end.
    Vec3d at(0, 0, 0), direction(0, 0, -1);
    for (int i = 0; i < mirrors_on_the_way; ++i) {
      const Vec3d turned = direction.z != 0 ? Vec3d(0, 1, 0) : Vec3d(0, 0, -1);
      at = at + direction * 10;
      scene["objects"].push_back({{"type", "disk"},
                                  {"center", numbers(at)},
                                  {"normal", numbers(turned - direction)},
                                  {"radius", 3},
                                  {"material", "silver"}});
      direction = turned;
    }
    at = at + direction * 10;
    scene["objects"].push_back({{"type", "disk"},
                                {"center", numbers(at)},
                                {"normal", numbers(-direction)},
                                {"radius", 3},
                                {"material", "paint"}});
    for (int i = 0; i < lights; ++i)
      scene["lights"].push_back({{"type", "point"}, {"position", numbers(at - direction * (2 + i))}});
    RenderRequest request = limits(8);
    request.width = 80;
    request.height = 60;
    request.full_model = true;  // the plan would skip shadow rays of a single wall
    return render(scene, request).stats.counts.rays;
  };
  constexpr std::uint64_t kPixels = 80 * 60;
  for (const int lights : {1, 2, 3}) {
    EXPECT_EQ(counts(0, lights).total(), (static_cast<std::uint64_t>(lights) + 1) * kPixels) << "d = 1";
    for (const int mirrors_on_the_way : {1, 2, 5}) {
      const RayCounts rays = counts(mirrors_on_the_way, lights);
      const auto k = static_cast<std::size_t>(mirrors_on_the_way);
      EXPECT_EQ(rays.total(), (k + 1 + static_cast<std::uint64_t>(lights)) * kPixels);
      for (std::size_t depth = 1; depth <= k; ++depth) EXPECT_EQ(rays.reflected[depth], kPixels);
      EXPECT_EQ(rays.shadow[k], static_cast<std::uint64_t>(lights) * kPixels)
          << "counted at the depth of the lit surface";
    }
  }
}

// Every bounce takes one ray, however small its weight. With the list, each ray takes one test per primitive.
TEST(RayTree, CostsSameForWeakAndStrongRays) {
  covers("A35");
  for (const double reflectance : {.5, 1e-4}) {  // 1e-4 ^ 33 is below the smallest float
    RenderRequest request = in_float(limits(32));
    request.width = request.height = 32;
    request.accelerator = "list";
    const Picture picture = render(mirrors(reflectance, 1), request);
    EXPECT_EQ(picture.stats.counts.rays.reflected[10], picture.stats.counts.rays.reflected[2]);
    EXPECT_EQ(picture.stats.non_finite_pixels, 0u);
    if (reflectance == .5) {
      EXPECT_EQ(picture.stats.counts.rays.reflected[32], 1024u);
      EXPECT_EQ(picture.stats.counts.accelerator.primitive_tests, 33u * 1024 * 2);
    }
  }
}

}  // namespace
}  // namespace orrery::test
