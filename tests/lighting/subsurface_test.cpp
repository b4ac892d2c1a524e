#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "tests/support/pictures.h"
#include "tests/support/slab.h"
#include "tests/support/tracing.h"

// Tests media that scatter light, against discrete ordinates, furnaces and other closed forms.
namespace orrery::test {
namespace {

Json medium(const Json& albedo, const Json& mean_free_path, double anisotropy = 0, double ior = 1) {
  return {{"type", "subsurface"},
          {"ior", ior},
          {"albedo", albedo},
          {"mean_free_path", mean_free_path},
          {"anisotropy", anisotropy}};
}
Json with(Json material, const char* key, const Json& value) {
  material[key] = value;
  return material;
}
// Returns a layer from z = `low` to `high`, so wide that no path reaches its edges.
Json layer(double low, double high, const char* material, double half = 1e5) {
  return {{"type", "box"}, {"min", {-half, -half, low}}, {"max", {half, half, high}}, {"material", material}};
}
Json ball(const Vec3d& centre, double radius, const char* material) {
  return {{"type", "sphere"}, {"center", numbers(centre)}, {"radius", radius}, {"material", material}};
}
// Returns a black half-space that hides the sky above (`side` = 1) or below (-1) the height z.
Json curtain(double z, double side) {
  return {{"type", "plane"}, {"point", {0, 0, z}}, {"normal", {0, 0, -side}}, {"material", "black"}};
}
// Returns a scene under a sky of radiance 1, with an eye outside all bodies.
Json under_sky(const Json& objects, Json materials) {
  materials["black"] = {{"type", "rough"}, {"kd", 0}};
  return scene_with(objects,
                    {{"materials", materials}, {"background", {1, 1, 1}}, {"camera", {{"eye", {0, 0, 1}}}}});
}
RenderRequest by_path(int max_depth = 4) {
  RenderRequest request;
  request.technique = "path";
  request.max_depth = max_depth;
  request.reuse = 1;
  return request;
}
const Ray<double> kDown{{0.1, 0.2, 1}, {0, 0, -1}};

// Mean radiance along one ray, and its standard error.
struct Measured {
  Vec3d mean, error;
  double largest_sum = 0, smallest_sum = 0;  // over the samples: sums over the channels
  TraceCounts counts;
};
Measured measure(const Json& scene, const Ray<double>& ray, const RenderRequest& request, int samples = 64) {
  Tracing tracing(scene, request);
  const std::vector<Ray<double>> rays(kBatch, ray);
  std::vector<Vec3d> means(kBatch);
  Measured found;
  found.smallest_sum = 1e300;
  for (int sample = 0; sample < samples; ++sample) {
    const auto answers = tracing.trace(rays, sample);
    for (std::size_t i = 0; i < means.size(); ++i) {
      const Vec3d& radiance = answers[i].radiance;
      const double sum = radiance.x + radiance.y + radiance.z;
      found.largest_sum = std::max(found.largest_sum, sum);
      found.smallest_sum = std::min(found.smallest_sum, sum);
      means[i] = means[i] + radiance * (1.0 / samples);
    }
  }
  Vec3d squares;
  for (const Vec3d& mean : means) found.mean = found.mean + mean * (1.0 / kBatch);
  for (const Vec3d& mean : means) {
    const Vec3d d = mean - found.mean;
    squares = squares + d * d;
  }
  const auto error = [](double sum) { return std::sqrt(sum) / kBatch; };
  found.error = {error(squares.x), error(squares.y), error(squares.z)};
  found.counts = tracing.counts();
  return found;
}
// Expects a mean within 4.5 standard errors, which must be at most `limit`.
void expect_mean(double mean, double error, double expected, double limit, const std::string& what) {
  EXPECT_NEAR(mean, expected, 4.5 * error + 1e-9) << what;
  EXPECT_LE(error, limit) << what;
}
std::string text(const SlabMedium& slab) {
  return Json{slab.thickness, slab.albedo, slab.anisotropy, slab.index}.dump();
}

// Expects the shares of a slab of this optical thickness, made of `objects` above z = -1000.
void expect_shares(const Json& objects, const Json& materials, const SlabMedium& slab, int max_depth,
                   int samples) {
  const SlabShares right = slab_shares(slab);
  Json lit_above = objects, lit_below = objects;
  lit_above.push_back(curtain(-1000, -1));
  lit_below.push_back(curtain(2, 1));
  const Measured back = measure(under_sky(lit_above, materials), kDown, by_path(max_depth), samples);
  const Measured through = measure(under_sky(lit_below, materials), kDown, by_path(max_depth), samples);
  expect_mean(back.mean.x, back.error.x, right.reflected, 3e-3, "reflected " + text(slab));
  expect_mean(through.mean.x, through.error.x, right.transmitted, 3e-3, "transmitted " + text(slab));
}

// Values of van de Hulst 1980 and Giovanelli 1955, as quoted by Wang, Jacques, Zheng, "MCML - Monte Carlo
// Modeling of Light Transport in Multi-layered Tissues", 1995.
TEST(SlabSolver, MatchesPublishedTables) {
  const SlabShares slab = slab_shares({2, 0.9, 0.75, 1});
  EXPECT_NEAR(slab.reflected, 0.09739, 1e-5);
  EXPECT_NEAR(slab.transmitted, 0.66096, 1e-5);
  EXPECT_NEAR(slab_shares({64, 0.9, 0, 1.5}).reflected, 0.2600, 1e-4);
  const SlabShares lossless = slab_shares({4, 1, 0.5, 1.4});
  EXPECT_NEAR(lossless.reflected + lossless.transmitted, 1, 1e-6);
  EXPECT_NEAR(slab_shares({1.5, 0, 0, 1}).transmitted, std::exp(-1.5), 1e-8);
}

TEST(Subsurface, SlabMatchesDiscreteOrdinates) {
  for (const SlabMedium& slab : {SlabMedium{1, 1, 0}, SlabMedium{1, 0.9, 0}, SlabMedium{2, 0.9, 0.75},
                                 SlabMedium{4, 0.95, -0.5}, SlabMedium{0.3, 0.6, 0.3}}) {
    const Json inside = medium(slab.albedo, 1 / slab.thickness, slab.anisotropy);
    expect_shares(Json::array({layer(-1, 0, "wax")}), {{"wax", inside}}, slab, 4, 48);
  }
}

TEST(Subsurface, RefractingSlabMatchesDiscreteOrdinates) {
  for (const SlabMedium& slab : {SlabMedium{1, 1, 0, 1.5}, SlabMedium{3, 0.9, 0.5, 1.33}}) {
    const Json inside = medium(slab.albedo, 1 / slab.thickness, slab.anisotropy, slab.index);
    expect_shares(Json::array({layer(-1, 0, "wax")}), {{"wax", inside}}, slab, 32, 48);
  }
}

TEST(Subsurface, HalfSpaceReflectsPublishedShare) {
  const Json ground{{"type", "plane"}, {"point", {0, 0, 0}}, {"normal", {0, 0, 1}}, {"material", "wax"}};
  const Measured back =
      measure(under_sky({ground}, {{"wax", medium(0.9, 0.01, 0, 1.5)}}), kDown, by_path(32), 48);
  expect_mean(back.mean.x, back.error.x, slab_shares({64, 0.9, 0, 1.5}).reflected, 3e-3, "Giovanelli 0.2600");
}

// A gap without a medium between parallel layers does not change a slab.
TEST(Subsurface, BodyInsideDisplacesMedium) {
  const Json clear = with(medium(0, 1e12), "priority", 1);
  expect_shares(Json::array({layer(-3, 0, "wax"), layer(-2, -1, "gap", 9e4)}),
                {{"wax", medium(0.9, 1)}, {"gap", clear}}, {2, 0.9}, 4, 48);
}

TEST(Subsurface, HigherPriorityDecidesWhereBodiesOverlap) {
  const Json objects = Json::array({layer(-2, 0, "thin"), layer(-3, -1, "dense", 9e4)});
  expect_shares(objects, {{"thin", medium(0.9, 2)}, {"dense", with(medium(0.9, 1), "priority", 1)}},
                {2.5, 0.9}, 4, 48);
  expect_shares(objects, {{"thin", with(medium(0.9, 2), "priority", 1)}, {"dense", medium(0.9, 1)}}, {2, 0.9},
                4, 48);
}

// The eye is in the layer, just below its upper side.
TEST(Subsurface, FindsMediumAroundEye) {
  Json scene = under_sky({layer(-1, 0, "fog"), curtain(-1000, -1)}, {{"fog", medium(0.9, 0.5)}});
  scene["camera"]["eye"] = {0, 0, -1e-9};
  const Measured back = measure(scene, {{0.1, 0.2, -1e-9}, {0, 0, -1}}, by_path(), 48);
  expect_mean(back.mean.x, back.error.x, slab_shares({2, 0.9}).reflected, 3e-3, "from inside");
}

// In uniform light, bodies that absorb nothing are invisible. With equal channels and smooth surfaces, each
// path returns exactly the light of the sky.
TEST(Subsurface, IsInvisibleInUniformLight) {
  for (const double ior : {1.0, 1.3}) {
    const Json scene = under_sky({ball({0, 0, -2}, 1, "milk")}, {{"milk", medium(1, 0.15, 0.4, ior)}});
    const Measured grey = measure(scene, {{0.3, 0.1, 1}, {0, 0, -1}}, by_path(32), 4);
    EXPECT_NEAR(grey.largest_sum, 3, 1e-9) << ior;
    EXPECT_NEAR(grey.smallest_sum, 3, 1e-9) << ior;
    EXPECT_GT(grey.counts.scatterings, 10'000u);
  }
  const Json rough = with(medium(1, 0.3, 0, 1.4), "roughness", 0.5);
  const Measured facets = measure(under_sky({ball({0, 0, -2}, 1, "milk")}, {{"milk", rough}}),
                                  {{0.3, 0.1, 1}, {0, 0, -1}}, by_path(32), 32);
  EXPECT_NEAR(facets.mean.x, 1, 4.5 * facets.error.x + 4e-3) << "rough glass conserves energy within 3e-3";
  EXPECT_LE(facets.error.x, 3e-3);
}

// The balance heuristic over the channels keeps the sum of the throughput, so every path returns light of
// sum 3.
TEST(Subsurface, BoundsWeightsOfDifferentChannels) {
  const Json scene = under_sky({ball({0, 0, -2}, 1, "milk")}, {{"milk", medium(1, {0.05, 0.4, 3}, -0.3)}});
  const Measured lossless = measure(scene, {{0.3, 0.1, 1}, {0, 0, -1}}, by_path(32), 32);
  EXPECT_NEAR(lossless.largest_sum, 3, 1e-9);
  EXPECT_NEAR(lossless.smallest_sum, 3, 1e-9);
  for (const auto channel : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
    expect_mean(lossless.mean.*channel, lossless.error.*channel, 1, 1e-2, "one channel");
}

TEST(Subsurface, ChannelsMatchMediaOfOneColour) {
  const std::array<double, 3> albedo{0.99, 0.8, 0.3}, path{0.7, 0.2, 1.5};
  const Json inside = medium(albedo, path, 0.2);
  const Json objects = Json::array({layer(-1, 0, "wax"), curtain(-1000, -1)});
  const Measured all = measure(under_sky(objects, {{"wax", inside}}), kDown, by_path(), 96);
  const auto expect_channel = [&](std::size_t k, double Vec3d::*channel) {
    const SlabShares right = slab_shares({1 / path[k], albedo[k], 0.2});
    expect_mean(all.mean.*channel, all.error.*channel, right.reflected, 4e-3, "channel " + std::to_string(k));
  };
  expect_channel(0, &Vec3d::x);
  expect_channel(1, &Vec3d::y);
  expect_channel(2, &Vec3d::z);
}

TEST(Subsurface, WithoutAlbedoEqualsFilterOfGlass) {
  const Vec3d path(0.3, 1, 4);
  const Json filter{std::exp(-1 / path.x), std::exp(-1 / path.y), std::exp(-1 / path.z)};
  for (const double roughness : {0.0, 0.4})
    for (const char* technique : {"whitted", "distributed", "path"}) {
      const Json common{{"ior", 1.4}, {"roughness", roughness}};
      Json glass = common, wax = common;
      glass.update({{"type", "glass"}, {"filter", filter}});
      wax.update({{"type", "subsurface"}, {"albedo", 0}, {"mean_free_path", numbers(path)}});
      const Json objects = Json::array({ball({0, 0, 0}, 1, "it"), layer(-3, -2.9, "black", 5)});
      RenderRequest request = in_double(size(16, 16));
      request.technique = technique;
      request.max_depth = 8;
      const auto expected = trace_picture(under_sky(objects, {{"it", glass}}), request);
      const auto found = trace_picture(under_sky(objects, {{"it", wax}}), request);
      double worst = 0;
      for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, length(found[i] - expected[i]));
      EXPECT_LE(worst, 1e-12) << technique << roughness;
    }
}

// Techniques without interreflection attenuate light by absorption and scattering alike.
TEST(Subsurface, OtherTechniquesAttenuateOnly) {
  for (const char* technique : {"whitted", "distributed"}) {
    RenderRequest request = by_path();
    request.technique = technique;
    const Json scene = under_sky({layer(-1, 0, "fog")}, {{"fog", medium(0.9, {0.5, 1, 2})}});
    const Vec3d seen = Tracing(scene, request).trace(kDown).radiance;
    EXPECT_LE(length(seen - Vec3d(std::exp(-2.0), std::exp(-1.0), std::exp(-0.5))), 1e-9) << technique;
  }
}

// Shadow rays inside a body are attenuated like other rays, so lamps inside keep uniform light uniform.
TEST(Subsurface, ContainsLampsAndOpaqueBodies) {
  const Json glow{{"type", "lambert"}, {"reflectance", 0.5}, {"emission", {0.5, 0.5, 0.5}}};
  const Json scene = under_sky(
      {ball({0, 0, -2}, 1, "milk"), ball({0.5, 0, -2}, 0.45, "glow"), ball({-0.48, 0.05, -2}, 0.45, "glow")},
      {{"milk", medium(1, 0.4)}, {"glow", glow}});
  for (const double x : {0.25, 0.0, -0.2}) {
    const Measured all = measure(scene, {{x, 0.05, 1}, {0, 0, -1}}, by_path(32), 96);
    expect_mean(all.mean.x, all.error.x, 1, 2e-3, std::to_string(x));
  }
}

TEST(Subsurface, DoesNotDependOnThreadsAndSlices) {
  const Json scene = under_sky({ball({0, 0, -1}, 1, "milk"), ball({0.2, 0, -1}, 0.4, "stone")},
                               {{"milk", medium({0.99, 0.9, 0.8}, {0.1, 0.2, 0.4}, 0.3, 1.3)},
                                {"stone", {{"type", "rough"}, {"kd", 0.5}}}});
  for (RenderRequest request : {in_float(size(70, 40)), in_double(size(70, 40))}) {
    request.technique = "path";
    request.samples = 2;
    request.max_depth = 6;
    const Picture one = render(scene, request, 1);
    EXPECT_GT(one.stats.counts.scatterings, 1000u);
    for (const int threads : {2, 3}) EXPECT_TRUE(identical(one, render(scene, request, threads)));
    request.slice = 48;
    EXPECT_TRUE(identical(one, render(scene, request, 1)));
  }
}

// Rays of one batch do not change the random numbers of each other.
TEST(Subsurface, RaysOfOneBatchAreIndependent) {
  const Json scene = under_sky({ball({0, 0, -2}, 1, "milk")}, {{"milk", medium(0.95, 0.1)}});
  const Ray<double> away{{0, 0, 1}, {0, 0, 1}};
  const std::vector<Ray<double>> all(64, kDown);
  Tracing tracing(scene, by_path());
  const auto together = tracing.trace(all);
  for (const std::size_t k : {0u, 13u, 63u}) {
    std::vector<Ray<double>> alone(64, away);
    alone[k] = kDown;
    EXPECT_EQ(tracing.trace(alone)[k].radiance, together[k].radiance) << k;
  }
}

TEST(Subsurface, EndsWalksInDenseBodies) {
  const Json scene = under_sky({ball({0, 0, -2}, 1, "stone")}, {{"stone", medium(1, 1e-9)}});
  const Measured dense = measure(scene, kDown, by_path(), 1);
  EXPECT_GT(dense.counts.cut_rays, 0u) << "omitted light is counted";
  EXPECT_LE(dense.counts.cut_rays, kBatch);
  EXPECT_LE(dense.counts.scatterings, std::uint64_t{kBatch} * kMaxScatterings);
  // A share of about (pi events)^(-1/2) of the walks is longer.
  EXPECT_NEAR(dense.mean.x, 1, 0.05);
  EXPECT_LE(dense.largest_sum, 3 + 1e-9);
}

// Ends the task after some checkpoints.
class LastSlice final : public TimeSlice {
 public:
  struct End {};
  explicit LastSlice(int left) : left_(left) {}
  void yield() override {
    if (left_-- == 0) throw End();
  }

 private:
  int left_;
};

TEST(Subsurface, WalkChecksForCancellation) {
  const Json scene = under_sky({ball({0, 0, -2}, 1, "stone")}, {{"stone", medium(1, 1e-9)}});
  Tracing tracing(scene, by_path());
  const std::vector<Ray<double>> rays(256, kDown);
  tracing.trace(rays);  // the walks of these rays last for kMaxScatterings events
  const std::uint64_t whole = tracing.counts().scatterings;
  LastSlice slice(100);
  const TaskScope scope({.time_slice = &slice});
  EXPECT_THROW(tracing.trace(rays), LastSlice::End);
  EXPECT_LT(tracing.counts().scatterings - whole, std::uint64_t{256} * 100);
}

std::string problem(const Json& material) {
  try {
    load(under_sky({ball({0, 0, 0}, 1, "it")}, {{"it", material}}));
  } catch (const InputError& error) {
    return error.problems().front().pointer + ": " + error.problems().front().detail;
  }
  return "accepted";
}

TEST(Subsurface, ReportsInvalidParameters) {
  const Json good = medium(0.5, 1);
  EXPECT_EQ(problem(good), "accepted");
  EXPECT_EQ(problem(with(good, "mean_free_path", {1, 0, 1})),
            "/materials/it/mean_free_path: must be at least 1e-12 in every channel (got 0)");
  EXPECT_EQ(problem(with(good, "mean_free_path", {1, 1, 1e13})),
            "/materials/it/mean_free_path/2: must be a number from 0 to 1e12 (got 10000000000000)");
  EXPECT_EQ(problem(with(good, "albedo", {0.5, 1.5, 0.5})),
            "/materials/it/albedo/1: must be a number from 0 to 1 (got 1.5)");
  EXPECT_EQ(problem(with(good, "anisotropy", 1)),
            "/materials/it/anisotropy: must be a number from -0.99 to 0.99 (got 1)");
  Json without = good;
  without.erase("albedo");
  EXPECT_EQ(problem(without).substr(0, 14), "/materials/it:");
}

// Float cannot represent the steps of a walk with a short mean free path.
TEST(Subsurface, UsesDoubleForShortMeanFreePath) {
  const auto uses_double = [](double mean_free_path) {
    const Json scene = under_sky({ball({0, 0, -2}, 1, "milk")}, {{"milk", medium(1, mean_free_path)}});
    RenderRequest request = by_path();
    request.width = request.height = 16;
    return make_plan(*load(scene), request).double_precision;
  };
  EXPECT_FALSE(uses_double(0.1));
  EXPECT_TRUE(uses_double(1e-6));
}

}  // namespace
}  // namespace orrery::test
