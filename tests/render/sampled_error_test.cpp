#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/random_optics.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// Tests the error that a render estimates from its samples.
namespace orrery::test {
namespace {

RenderRequest of(int side, int samples, int reuse, std::uint64_t seed) {
  RenderRequest request = size(side, side);
  request.samples = samples;
  request.reuse = reuse;
  request.seed = seed;
  return request;
}

// Compares the estimate with the true mean squared error, half the mean squared difference between images of
// different seeds. At edges the halves of the samples are not independent, so the estimate may be up to 1.6
// times too large.
TEST(SampledError, MatchesErrorOfImage) {
  covers("light-47 D17");
  constexpr int kSeeds = 12;
  const auto box = load(sample("cornell-box"));
  for (const int reuse : {1, 16}) {
    std::vector<Picture> pictures;
    double told = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      pictures.push_back(render(box, of(64, 16, reuse, static_cast<std::uint64_t>(seed))));
      told += std::pow(pictures.back().stats.error.pixel.rmse(), 2) / kSeeds;
    }
    double squares = 0;
    for (int a = 0; a < kSeeds; a += 2)
      for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i)
        for (float Vec3f::*channel : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
          const auto& p = pictures[static_cast<std::size_t>(a)].pixels[i];
          const auto& q = pictures[static_cast<std::size_t>(a) + 1].pixels[i];
          squares += std::pow(double{p.*channel} - q.*channel, 2);
        }
    const double truth = squares / (kSeeds * 3.0 * static_cast<double>(pictures[0].pixels.size()));
    EXPECT_GT(std::sqrt(told / truth), 0.97) << reuse;
    EXPECT_LT(std::sqrt(told / truth), 1.6) << reuse;
    const auto [low, high] = pictures[0].stats.error.interval();
    EXPECT_LT(low, pictures[0].stats.error.pixel.rmse());
    EXPECT_GT(high, pictures[0].stats.error.pixel.rmse());
  }
}

// In random scenes, the estimate is compared with images of other seeds. The estimate may be up to 1.6 times
// too large at edges, and up to 4 times in smooth images.
TEST(SampledError, MatchesErrorOverOtherSeeds) {
  covers("certificate-27");
  Random random(27);
  int told = 0, near = 0;
  for (int k = 0; k < 30; ++k) {
    const auto scene = load(random_optics(random));
    double squares = 0, halves = 0;
    for (const std::uint64_t pair : {0, 1}) {
      const Picture a = render(scene, of(96, 16, 1, 2 * pair)),
                    b = render(scene, of(96, 16, 1, 2 * pair + 1));
      for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Vec3f d = a.pixels[i] - b.pixels[i];
        squares += double{dot(d, d)} / static_cast<double>(12 * a.pixels.size());
      }
      for (const Picture* p : {&a, &b}) halves += std::pow(p->stats.error.pixel.rmse(), 2) / 4;
    }
    if (squares == 0) continue;  // black images
    ++told;
    EXPECT_GT(std::sqrt(halves / squares), 0.97) << k;
    EXPECT_LT(std::sqrt(halves / squares), 4) << k;
    near += std::sqrt(halves / squares) < 1.6;
  }
  EXPECT_GE(told, 25);
  EXPECT_GE(near, told - 2);
}

// Non-finite pixels are reported separately, and the total error is unknown.
TEST(SampledError, ExcludesNonFinitePixels) {
  covers("certificate-28");
  const auto scene = load(scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"));
  const Plan plan = make_plan(*scene, of(32, 2, 1, 0));
  RenderStats stats;
  stats.error.samples = 2;
  stats.error.pixel = {.squares = 1, .values = 100};
  stats.non_finite_pixels = 3;
  const Certificate certificate = certify(plan, stats);
  EXPECT_EQ(certificate.total().kind, Bound::Kind::unknown);
  EXPECT_EQ(certificate.terms.back().reason, "3 pixels are not finite");
}

TEST(SampledError, IsKnownOnlyForEvenSampleCounts) {
  const auto box = load(sample("cornell-box"));
  EXPECT_FALSE(render(box, of(32, 1, 1, 0)).stats.error.known());
  EXPECT_FALSE(render(box, of(32, 3, 1, 0)).stats.error.known());
  EXPECT_TRUE(render(box, of(32, 2, 1, 0)).stats.error.known());
}

TEST(SampledError, IsZeroForConstantImage) {
  RenderRequest request = size(40, 40);
  request.samples = 4;
  const Picture picture = render(
      scene_of("[{'type': 'sphere', 'center': [0, 0, 50], 'radius': 1}]", "{'background': [0.25, 0.5, 1]}"),
      request);
  EXPECT_TRUE(picture.stats.error.known());
  EXPECT_EQ(picture.stats.error.pixel.rmse(), 0);
  EXPECT_EQ(picture.stats.error.block32.values, 3);  // one whole tile
}

}  // namespace
}  // namespace orrery::test
