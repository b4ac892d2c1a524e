#include "core/accuracy/certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/render/progressive.h"
#include "core/techniques/registry.h"
#include "tests/render/random_optics.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Tests the ledger of omitted contributions, the range of radiance, and bounds on sampling errors.
namespace orrery {
namespace {

using test::covers;
using test::Json;
using test::json;

RenderRequest request(int max_depth, double min_contribution = 0) {
  RenderRequest r;
  r.technique = "whitted";
  r.max_depth = max_depth;
  r.min_contribution = min_contribution;
  r.precision = Precision::double_precision;
  r.width = r.height = kTileSide;
  return r;
}

std::vector<Ray<double>> camera_rays(const Plan& plan) {
  const auto rays = std::make_unique<RayBatch<double>>();
  plan.camera->generate(plan.frame, plan.width, plan.height, TileView{0, 0, kTileSide, kTileSide},
                        TileSamples::centres(), *rays);
  std::vector<Ray<double>> found;
  for (int i = 0; i < kBatch; ++i) found.push_back({rays->origin[i], rays->direction[i]});
  return found;
}

// Ratios of bound to error, one element per image with omissions.
struct Tightness {
  std::vector<double> of_max, of_rms;
};
double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

// Compares a limited render with the full ray tree, whose ledger is added to the bound.
void expect_within_bounds(const Json& scene, const RenderRequest& cut, Tightness& tightness) {
  const auto loaded = test::load(scene);
  const Plan plan = make_plan(*loaded, cut);
  const std::vector<Ray<double>> rays = camera_rays(plan);
  const auto planned = test::Tracing(loaded, cut, test::Tracing::Ledger::light).trace(rays);
  const auto full = test::Tracing(loaded, request(20, 1e-5), test::Tracing::Ledger::light).trace(rays);
  double max_bound = 0, max_error = 0, bounds = 0, errors = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3d bound = planned[i].weights, rest = full[i].weights;
    const Vec3d error = abs(planned[i].radiance - full[i].radiance);
    for (const auto channel : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
      ASSERT_LE(error.*channel, bound.*channel + rest.*channel + 1e-12) << scene.dump().substr(0, 2000);
      max_bound = std::max(max_bound, bound.*channel);
      max_error = std::max(max_error, error.*channel);
      bounds += bound.*channel * bound.*channel;
      errors += error.*channel * error.*channel;
    }
  }
  if (max_error < 1e-4) return;
  tightness.of_max.push_back(max_bound / max_error);
  tightness.of_rms.push_back(std::sqrt(bounds / errors));
}

TEST(Ledger, BoundsErrorOfRandomScenes) {
  covers("certificate-1");
  test::Random random = test::scenes_seed();
  Tightness depth, threshold;
  for (int i = 0; i < 200; ++i) {
    const Json scene = test::random_optics(random);
    expect_within_bounds(scene, request(1 + i % 4), depth);
    expect_within_bounds(scene, request(20, i % 2 == 0 ? 0.05 : 0.2), threshold);
  }
  for (const auto& [name, found] : {std::pair{"depth", depth}, {"threshold", threshold}}) {
    ASSERT_GT(found.of_max.size(), 100u);
    EXPECT_LE(median(found.of_max), 2.8) << name;
    EXPECT_LE(median(found.of_rms), 3.6) << name;
    RecordProperty(std::string(name) + "_max", std::to_string(median(found.of_max)));
    RecordProperty(std::string(name) + "_rms", std::to_string(median(found.of_rms)));
  }
}

TEST(RadianceRange, ContainsRadianceOfRandomScenes) {
  covers("certificate-6");
  test::Random random = test::scenes_seed();
  for (int i = 0; i < 200; ++i) {
    const auto scene = test::load(test::random_optics(random));
    const RadianceRange& range = scene->facts.tree_radiance;
    ASSERT_TRUE(range.finite());
    const RenderRequest r = request(12);
    for (const auto& [radiance, weights, cut] :
         test::Tracing(scene, r).trace(camera_rays(make_plan(*scene, r))))
      for (const auto channel : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        // Ambient light that replaces omitted rays is not part of the scene's radiance.
        ASSERT_LE(radiance.*channel, range.most.*channel + weights.*channel * scene->ambient.*channel + 1e-12)
            << scene->canonical.substr(0, 2000);
        ASSERT_GE(radiance.*channel, range.least.*channel) << scene->canonical.substr(0, 2000);
      }
  }
}

// The plum ball reflects .3 of the ambient light of .4. It reflects the light of 2 by a factor of .3, and by
// a factor of 2 in the highlight. The sum is .12 + 4.6.
TEST(RadianceRange, MatchesHandComputedPaperScene) {
  covers("certificate-6");
  const auto scene = test::load(test::sample("paper"));
  EXPECT_NEAR(max_component(scene->facts.tree_radiance.most), 4.72, 1e-9);
}

TEST(RadianceRange, DecreasesWithDistanceOfLights) {
  const auto most = [](const char* lights) {
    return test::load(test::scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}",
                                     std::string("{'lights': [") + lights + "]}"))
        ->facts.tree_radiance.most.x;
  };
  // The box is 9 m from the light, and its white material reflects all light.
  EXPECT_NEAR(most("{'type': 'point', 'position': [10, 0, 0], 'attenuation': [1, 0, 1]}"), 1.0 / 82, 1e-12);
  EXPECT_NEAR(most("{'type': 'point', 'position': [10, 0, 0], 'attenuation': [1, 0, 0]}"), 1, 1e-12);
  EXPECT_NEAR(most("{'type': 'directional', 'direction_to_light': [1, 0, 0], 'intensity': [3, 3, 3]}"), 3,
              1e-12);
}

// Emission of a specular surface adds up over repeated reflections. Ambient light does not, because a coat
// attenuates it.
TEST(RadianceRange, IsUnknownForEmissiveSpecularSurfaces) {
  const auto finite = [](const char* material, const char* ambient) {
    return test::load(test::scene_of(
                          "{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'm'}",
                          std::string("{'materials': {'m': ") + material + "}, 'ambient': " + ambient + "}"))
        ->facts.tree_radiance.finite();
  };
  EXPECT_TRUE(finite("{'type': 'glass'}", "[1, 1, 1]"));
  EXPECT_FALSE(finite("{'type': 'glass', 'emission': [1, 0, 0]}", "[1, 1, 1]"));
  EXPECT_TRUE(finite("{'type': 'plastic', 'roughness': 0}", "[0, 0, 0]"));
  EXPECT_TRUE(finite("{'type': 'plastic', 'roughness': 0}", "[1, 1, 1]"))
      << "ambient light is attenuated by 1 - R";
  EXPECT_TRUE(finite("{'type': 'plastic', 'roughness': 0.5}", "[1, 1, 1]"));
}

// A lamp of radiance L and albedo a in a closed room limits radiance to L / (1 - a).
TEST(RadianceRange, MatchesGeometricSeriesForPaths) {
  const Json scene = test::scene_of(
      "[{'type': 'box', 'min': [-2, -2, -2], 'max': [2, 2, 2], 'material': 'wall'},"
      " {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.5, 'material': 'lamp'}]",
      "{'materials': {'wall': {'type': 'lambert', 'reflectance': 0.9},"
      " 'lamp': {'type': 'lambert', 'reflectance': 0.5, 'emission': [3, 2, 1]}}, 'background': [1, 1, 1]}");
  const Vec3d most = test::load(scene)->facts.path_radiance.most;
  EXPECT_NEAR(most.x, 6, 1e-12);
  EXPECT_NEAR(most.y, 4, 1e-12);
  EXPECT_NEAR(most.z, 2, 1e-12);
  Json mirror = scene;
  mirror["materials"]["lamp"]["reflectance"] = 1;
  EXPECT_FALSE(test::load(mirror)->facts.path_radiance.finite()) << "light may be reflected forever";
}

// Facing mirrors of reflectance .95: the light omitted beyond depth 5 is .95^6 of the range.
TEST(Ledger, MatchesClosedFormForCorridor) {
  covers("certificate-3");
  const double n = (1 + std::sqrt(.95)) / (1 - std::sqrt(.95));
  const Json scene = test::scene_with(
      json("[{'type': 'plane', 'point': [0, 0, -5], 'normal': [0, 0, 1], 'material': 'mirror'},"
           " {'type': 'plane', 'point': [0, 0, 5], 'normal': [0, 0, -1], 'material': 'mirror'}]"),
      Json{{"materials",
            {{"mirror", {{"type", "reflective"}, {"n", {n, n, n}}, {"k", {0, 0, 0}}, {"fresnel", "exact"}}}}},
           {"background", {1, 1, 1}},
           {"camera",
            {{"type", "perspective"}, {"eye", {0, 0, 4}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 1}}}});
  const test::Picture picture = test::render(scene, request(5));
  const double left = std::pow(.95, 6);
  EXPECT_GE(picture.stats.omitted.rms(), left * (1 - 1e-4));
  EXPECT_LE(picture.stats.omitted.max(), 1.2 * left);
}

// A ray beyond the critical angle never leaves a glass slab. All of its light is omitted, but the bound is
// finite.
TEST(Ledger, CoversWholeRangeInLightGuide) {
  covers("certificate-4");
  const Json scene = test::scene_with(
      json("[{'type': 'box', 'min': [-500, -1, -500], 'max': [500, 1, 500], 'material': 'glass'}]"),
      Json{{"materials", {{"glass", {{"type", "refractive"}, {"ior", 1.5}, {"fresnel", "exact"}}}}},
           {"background", {2, 1, 0}}});
  const auto loaded = test::load(scene);
  const Plan plan = make_plan(*loaded, request(8));
  EXPECT_EQ(plan.cut_range, Vec3d(2, 1, 0));
  const auto answer =
      test::Tracing(loaded, request(8)).trace(Ray<double>{{0, 0, 0}, safe_normalize(Vec3d(1, 0.3, 0))});
  EXPECT_EQ(answer.radiance, Vec3d(0));
  EXPECT_NEAR(max_component(answer.weights), 1, 1e-12);
}

// Omitted rays are replaced by ambient light, which may be too bright.
TEST(Ledger, CountsTooBrightSubstitutes) {
  const auto loaded = test::load(
      test::scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'glass'}]"),
                       Json{{"materials", {{"glass", {{"type", "refractive"}, {"ior", 1.5}}}}},
                            {"ambient", {0.9, 0.9, 0.9}},
                            {"background", {0.1, 0.5, 1}}}));
  EXPECT_EQ(make_plan(*loaded, request(1)).cut_range, Vec3d(0.9, 0.9, 0.9));
}

// Renders 60 seeds with 4 samples. Returns the number of images whose bound is at least their error, compared
// with `samples_of_truth` samples. Calls check(certificate, error) for each image.
template <class Check>
int count_bounded_seeds(const Json& scene, RenderRequest r, int samples_of_truth, const Check& check) {
  const auto loaded = test::load(scene);
  const auto values_of = [&](const Film& film) {
    const std::vector<double> linear = test::linear_values(film);
    return r.space == Space::display ? test::shown(linear) : linear;
  };
  r.width = r.height = 64;
  r.samples = samples_of_truth;
  r.seed = 1000;
  const std::vector<double> truth = values_of(test::rendered(loaded, r).film);
  int held = 0;
  r.samples = 4;
  for (r.seed = 0; *r.seed < 60; ++*r.seed) {
    const RenderResult result = test::rendered(loaded, r);
    const double error = test::rms_difference(values_of(result.film), truth);
    held += *result.certificate.total().rms >= error;
    check(result.certificate, error);
  }
  return held;
}

// The scenes have edges, highlights in glass, and dots that cover one pixel in a hundred.
TEST(Certificate, BoundsSamplingErrorOverSeeds) {
  covers("certificate-17");
  Json dots = test::scene_with(json("[]"));
  dots["materials"]["lamp"] = json("{'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}");
  for (int i = 0; i < 40; ++i)
    dots["objects"].push_back({{"type", "sphere"},
                               {"center", {(i % 8 - 3.5) * 0.4, (i / 8 - 2) * 0.5, 0}},
                               {"radius", 0.025},
                               {"material", "lamp"}});
  for (const Json& scene : {test::sample("paper"), test::sample("glass"), dots}) {
    const int held = count_bounded_seeds(scene, request(5), 1024, [](const Certificate&, double) {});
    EXPECT_GE(held, 56) << scene["title"];
  }
}

// On a display, path radiance has a finite range. With path reuse, errors are correlated within a tile.
TEST(Certificate, BoundsPathErrorOnDisplay) {
  covers("certificate-17 certificate-18");
  for (const char* name : {"cornell-box", "outdoors"}) {
    for (const int reuse : {1, 16}) {
      RenderRequest r;
      r.precision = Precision::double_precision;
      r.space = Space::display;
      r.max_depth = 12;
      r.reuse = reuse;
      const auto check = [&](const Certificate& certificate, double error) {
        EXPECT_GE(*certificate.estimate, 0.9 * error) << name << " " << reuse;
      };
      EXPECT_GE(count_bounded_seeds(test::sample(name), r, 512, check), 56) << name << " " << reuse;
    }
  }
}

TEST(Certificate, DetectsCorrelatedPixelErrors) {
  covers("certificate-22");
  Plan plan;
  plan.technique = &technique_types()[0];
  plan.double_precision = true;
  plan.sample_range = 1;
  plan.width = plan.height = 128;
  RenderStats stats;
  test::Random random(1);
  int erring_tiles = 16;
  const auto kind_of = [&](double shared) {  // `shared` is the correlated fraction of the error in a tile
    stats = {};
    for (int tile = 0; tile < 16; ++tile) {
      const double of_tile = random.between(-1, 1), scale = tile < erring_tiles ? random.unit() : 0;
      double sum = 0, squares = 0;
      for (int pixel = 0; pixel < kBatch; ++pixel) {
        const double error = scale * (shared * of_tile + (1 - shared) * random.between(-1, 1));
        sum += error;
        squares += error * error;
        stats.halves.add(error * error);
      }
      stats.halves.add_tile(squares);
      stats.error.add({.samples = 4,
                       .pixel = {3 * squares, 3.0 * kBatch},
                       .block4 = {},
                       .block32 = {3 * sum * sum / kBatch / kBatch, 3},
                       .tiles = 1,
                       .tile_sum = squares / kBatch,
                       .tile_squares = squares / kBatch * squares / kBatch});
    }
    return certify(plan, stats).total().kind;
  };
  for (erring_tiles = 1; erring_tiles <= 16; erring_tiles += 5)
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(kind_of(0), Bound::Kind::estimated) << erring_tiles << " " << i;
  erring_tiles = 2;
  EXPECT_EQ(kind_of(1), Bound::Kind::unknown);
  erring_tiles = 16;
  EXPECT_EQ(kind_of(1), Bound::Kind::unknown);
  EXPECT_EQ(kind_of(0.3), Bound::Kind::unknown);
  plan.reuse = 16;  // path reuse, so correlation is expected
  EXPECT_EQ(kind_of(0.3), Bound::Kind::estimated);
  plan.reuse = 1;
  kind_of(0);
  stats.error = {.samples = 4, .pixel = {1, 1}, .block4 = {}, .block32 = {}};
  const double of_pixels = *certify(plan, stats).total().rms;
  plan.reuse = 16;
  EXPECT_GT(*certify(plan, stats).total().rms, 1.05 * of_pixels)
      << "the bound from 16 tiles is weaker than from their pixels";
}

// A root mean square is at most the maximum, and two display values differ by at most 1.
TEST(Certificate, LimitsDisplayErrorToLargestDifference) {
  RenderRequest r = request(32, 0.5);
  r.space = Space::display;
  const auto scene = test::load(test::sample("mirrors"));
  RenderStats stats;
  stats.counts.cut_rays = 1;
  const auto rms_of = [&](double b) {
    stats.omitted = {.sum = b, .squares = b * b, .largest = b, .values = 1, .samples = 1};
    const Bound bound = certify(make_plan(*scene, r), stats).terms.front().bound;
    EXPECT_LE(*bound.rms, *bound.max) << b;
    return *bound.rms;
  };
  EXPECT_LT(rms_of(0.001), 0.0130) << "smaller than the bound from the mean alone";
  EXPECT_EQ(rms_of(3), 1);
  Certificate both{{{"a", Bound::proved(0.9, 0.8)}, {"b", Bound::proved(0.4, 0.3)}}, Space::display};
  EXPECT_EQ(both.total().max, 1);
  EXPECT_EQ(both.total().rms, 1);
  both.space = Space::linear;
  EXPECT_EQ(both.total().max, 1.3);
}

// All pixels of a tile have the same error, so only tiles are independent.
TEST(Halves, BoundsMeanIfOnlyTilesAreIndependent) {
  test::Random random(1);
  int held = 0, held_by_pixels = 0;
  for (int run = 0; run < 1000; ++run) {
    Halves halves;
    for (int tile = 0; tile < 64; ++tile) {
      const double value = random.unit();
      for (int pixel = 0; pixel < 100; ++pixel) halves.add(value);
      halves.add_tile(100 * value);
    }
    held += halves.upper_mean(0.05, true) >= 0.5;
    held_by_pixels += halves.upper_mean(0.05, false) >= 0.5;
  }
  EXPECT_GE(held, 930);
  EXPECT_LT(held_by_pixels, 800);
}

// Compares with tables of Student's t distribution.
TEST(StudentQuantile, MatchesTables) {
  for (const auto& [degrees, t] : {std::pair{1, 12.7062},
                                   {2, 4.30265},
                                   {3, 3.18245},
                                   {4, 2.77645},
                                   {10, 2.22814},
                                   {31, 2.03951},
                                   {120, 1.97993},
                                   {200, 1.97190},
                                   {100'000, 1.97190}})
    EXPECT_NEAR(student_quantile(0.025, degrees), t, 1e-4 * t) << degrees;
  EXPECT_NEAR(student_quantile(0.05, 5), 2.01505, 1e-4);
}

TEST(Certificate, StaysCloseToSampleEstimate) {
  RenderRequest r = request(5);
  r.width = r.height = 64;
  r.samples = 2;
  const Certificate certificate =
      test::rendered(test::load(test::sample("material-refractive")), r).certificate;
  EXPECT_GT(*certificate.total().rms, *certificate.estimate);
  EXPECT_LT(*certificate.total().rms, 1.5 * *certificate.estimate);
}

// The samples of a constant image have no variance, but the certificate must not claim zero error.
TEST(Certificate, NeverReportsZeroErrorFromSamples) {
  covers("certificate-20");
  const auto empty = test::load(
      test::scene_of("{'type': 'sphere', 'center': [0, 0, 99], 'radius': 1}", "{'background': [2, 2, 2]}"));
  RenderRequest r = request(5);
  r.width = r.height = 64;
  r.samples = 16;
  const Certificate certificate = test::rendered(empty, r).certificate;
  EXPECT_EQ(certificate.estimate, 0);
  EXPECT_EQ(certificate.total().kind, Bound::Kind::estimated);
  EXPECT_GE(*certificate.total().rms, 2 * std::sqrt(std::log(20) / (64 * 64)) / 2);
  EXPECT_EQ(certificate.total().rms, certificate.min_provable) << "the smallest provable error";
  r.technique = "path";  // the radiance of paths has no bound in linear space
  EXPECT_EQ(test::rendered(empty, r).certificate.total().kind, Bound::Kind::unknown);
}

TEST(Certificate, HasKindOfWeakestTerm) {
  const auto certificate_of = [](const Json& scene, const RenderRequest& r) {
    return test::rendered(test::load(scene), r).certificate;
  };
  const Json glass = test::sample("material-refractive");
  RenderRequest r = request(3);
  r.samples = 1;
  const Certificate single = certificate_of(glass, r);
  EXPECT_EQ(single.total().kind, Bound::Kind::unknown) << "one sample gives no error estimate";
  EXPECT_FALSE(single.total().rms);
  EXPECT_EQ(single.known().kind, Bound::Kind::proved);
  EXPECT_GT(*single.known().max, *single.known().rms);
  r.samples = 4;
  const Certificate several = certificate_of(glass, r);
  EXPECT_EQ(several.total().kind, Bound::Kind::estimated);
  EXPECT_GT(*several.total().rms, *several.estimate) << "sum of ledger and confidence interval";
  EXPECT_FALSE(several.total().max);
  r.precision = Precision::single_precision;
  EXPECT_EQ(certificate_of(glass, r).total().kind, Bound::Kind::unknown) << "errors of float have no bound";
}

// Renders the same samples with and without the clamp. The ledger equals the difference in each channel.
TEST(Clamp, ReportsRemovedLightInLedger) {
  covers("light-50");
  for (const char* name : {"cornell-box", "material-glass", "outdoors"})
    for (const int reuse : {1, 16}) {
      const auto loaded = test::load(test::sample(name));
      RenderRequest r = request(6);
      r.technique = "path";
      r.width = r.height = 48;
      r.samples = 4;
      r.reuse = reuse;
      const test::Picture all = test::render(loaded, r);
      r.clamp_indirect = 0.3;
      const test::Picture some = test::render(loaded, r);
      const ClampLedger& away = some.stats.clamped;
      EXPECT_GT(away.mean(0), 0) << name;
      std::size_t c = 0;
      for (float Vec3f::*channel : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
        const double pixels = 48 * 48, whole = all.sum(channel) / pixels;
        EXPECT_NEAR(whole - some.sum(channel) / pixels, away.mean(c), 1e-6 * whole) << name << reuse;
        ++c;
      }
      r.clamp_indirect = 1e6;  // never reached
      EXPECT_LE(largest_difference(all, test::render(loaded, r)), 1e-5 * 30) << name;
    }
}

// The lamp, its direct light and its mirror image count as direct. Only further reflections are clamped.
TEST(Clamp, KeepsDirectLight) {
  const auto lit = test::load(
      test::scene_of("[{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0], 'material': 'floor'},"
                     " {'type': 'rectangle', 'corner': [-1, 2, -1], 'edge_u': [2, 0, 0], 'edge_v': [0, 0, "
                     "2], 'material': 'lamp'}]",
                     "{'materials': {'floor': {'type': 'metal', 'name': 'iron', 'roughness': 0.4},"
                     " 'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [9, 9, 9]}}}"));
  RenderRequest r = request(4);
  r.technique = "path";
  r.samples = 4;
  for (const int reuse : {1, 16}) {
    r.reuse = reuse;
    r.clamp_indirect = 0;
    const test::Picture all = test::render(lit, r);
    r.clamp_indirect = 1e-6;
    const test::Picture some = test::render(lit, r);
    EXPECT_LE(largest_difference(all, some), 1e-5) << reuse;
    EXPECT_EQ(some.stats.clamped.mean(0), 0) << reuse;
  }
}

// The summed ledger of the passes is at least the ledger of a render in one pass.
TEST(Certificate, SumsPassLedgersForWholeRender) {
  const auto loaded = test::load(test::sample("material-refractive"));
  RenderRequest r = request(2);
  r.samples = 8;
  const PreparedScene prepared(loaded);
  const SettledPlan plan = settle(prepared, make_plan(*loaded, r));
  const OmissionLedger whole =
      render_frame(prepared, plan, FilmStorage::linear32, test::shared_executor()).stats.omitted;
  ProgressiveRender passes(prepared, plan, test::shared_executor(), {});
  for (const int samples : {2, 4, 8}) passes.refine(samples);
  const OmissionLedger& joined = passes.stats().omitted;
  EXPECT_EQ(joined.samples, 8);
  EXPECT_NEAR(joined.mean(), whole.mean(), 1e-9);
  EXPECT_GE(joined.rms(), whole.rms() * (1 - 1e-9));
  EXPECT_LE(joined.rms(), 1.2 * whole.rms());
  EXPECT_GE(joined.max(), whole.max() * (1 - 1e-9));
}

}  // namespace
}  // namespace orrery
