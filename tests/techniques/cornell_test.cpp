#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/sanitized.h"

// Tests the Cornell box: its data, and the contribution of each path length.
namespace orrery::test {
namespace {

using Quad = std::array<Vec3d, 4>;

// Returns the corners in canonical order.
Quad in_order(Quad quad) {
  std::sort(quad.begin(), quad.end(), [](const Vec3d& a, const Vec3d& b) {
    return std::tuple(std::llround(a.x * 1e7), std::llround(a.y * 1e7), std::llround(a.z * 1e7)) <
           std::tuple(std::llround(b.x * 1e7), std::llround(b.y * 1e7), std::llround(b.z * 1e7));
  });
  return quad;
}

// Returns the corners of each quad, which the mesh stores as two triangles.
std::vector<Quad> quads_of(const Json& mesh) {
  std::vector<Quad> quads;
  const Json &positions = mesh["positions"], &indices = mesh["indices"];
  for (std::size_t i = 0; i < positions.size(); i += 4) {
    EXPECT_EQ(indices[i / 2], Json({i, i + 1, i + 2}));
    EXPECT_EQ(indices[i / 2 + 1], Json({i, i + 2, i + 3}));
    quads.push_back(in_order({vector(positions[i]), vector(positions[i + 1]), vector(positions[i + 2]),
                              vector(positions[i + 3])}));
  }
  return quads;
}

// Expects a quad with these corners, in millimetres, and removes it from the list.
void expect_one(std::vector<Quad>& quads, Quad corners) {
  for (Vec3d& corner : corners) corner = corner / 1000;
  corners = in_order(corners);
  const auto found = std::find_if(quads.begin(), quads.end(), [&](const Quad& quad) {
    double off = 0;
    for (std::size_t i = 0; i < 4; ++i) off = std::max(off, max_component(abs(quad[i] - corners[i])));
    return off < 1e-15;
  });
  ASSERT_NE(found, quads.end()) << corners[0].x << " " << corners[0].y << " " << corners[0].z;
  quads.erase(found);
}

// Expects a block with this top, that is, the top and a wall below each side, and removes its quads.
void expect_block(std::vector<Quad>& quads, const Quad& top) {
  expect_one(quads, top);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d &a = top[i], &b = top[(i + 1) % 4];
    expect_one(quads, {a, b, Vec3d(b.x, 0, b.z), Vec3d(a.x, 0, a.z)});
  }
}

// Cornell University Program of Computer Graphics, "Cornell Box Data": positions in millimetres, a camera of
// focal length 0.035 over a film of 0.025 x 0.025. The spectra do not determine linear RGB colours. The scene
// uses the colours of the Tungsten renderer's scene, as its description states.
TEST(CornellBox, MatchesPublishedData) {
  covers("light-39");
  const Json scene = sample("cornell-box");
  std::vector<Quad> white = quads_of(scene["objects"][0]), green = quads_of(scene["objects"][1]),
                    red = quads_of(scene["objects"][2]);
  expect_one(white, {Vec3d(552.8, 0, 0), Vec3d(0, 0, 0), Vec3d(0, 0, 559.2), Vec3d(549.6, 0, 559.2)});
  expect_one(white,
             {Vec3d(549.6, 0, 559.2), Vec3d(0, 0, 559.2), Vec3d(0, 548.8, 559.2), Vec3d(556, 548.8, 559.2)});
  expect_block(white, {Vec3d(130, 165, 65), Vec3d(82, 165, 225), Vec3d(240, 165, 272), Vec3d(290, 165, 114)});
  expect_block(white,
               {Vec3d(423, 330, 247), Vec3d(265, 330, 296), Vec3d(314, 330, 456), Vec3d(472, 330, 406)});
  expect_one(green, {Vec3d(0, 0, 559.2), Vec3d(0, 0, 0), Vec3d(0, 548.8, 0), Vec3d(0, 548.8, 559.2)});
  expect_one(red,
             {Vec3d(552.8, 0, 0), Vec3d(549.6, 0, 559.2), Vec3d(556, 548.8, 559.2), Vec3d(556, 548.8, 0)});
  EXPECT_TRUE(green.empty() && red.empty());
  // The ceiling measures 556 x 559.2. The lamp extends from [213, 227] to [343, 332].
  const Json& lamp = scene["objects"][3];
  EXPECT_EQ(lamp["corner"], Json({0.213, 0.5488, 0.227}));
  EXPECT_EQ(lamp["edge_u"], Json({0.13, 0, 0}));
  EXPECT_EQ(lamp["edge_v"], Json({0, 0, 0.105}));
  double area = 0.13 * 0.105;
  for (const Quad& part : white) {
    for (const Vec3d& corner : part) EXPECT_EQ(corner.y, 0.5488);
    area += (part[3].x - part[0].x) * (part[3].z - part[0].z);
  }
  EXPECT_NEAR(area, 0.556 * 0.5592, 1e-12);
  EXPECT_EQ(scene["camera"]["eye"], Json({0.278, 0.273, -0.8}));
  EXPECT_EQ(scene["camera"]["look_at"], Json({0.278, 0.273, 0}));
  EXPECT_NEAR(scene["camera"]["fov_degrees"].get<double>(),
              2 * std::atan(0.0125 / 0.035) * 180 / std::numbers::pi, 1e-6);
  EXPECT_NE(scene["description"].get<std::string>().find("Tungsten"), std::string::npos);
  EXPECT_EQ(scene["materials"]["white"]["kd"], Json({0.725, 0.71, 0.68}));
  EXPECT_EQ(scene["materials"]["green"]["kd"], Json({0.14, 0.45, 0.091}));
  EXPECT_EQ(scene["materials"]["red"]["kd"], Json({0.63, 0.065, 0.05}));
  EXPECT_EQ(scene["materials"]["lamp"]["emission"], Json({17, 12, 4}));
}

constexpr std::array kChannels{&Vec3f::x, &Vec3f::y, &Vec3f::z};

RenderRequest alone(int side, int samples, int max_depth, std::uint64_t seed) {
  RenderRequest request = size(side, side);
  request.samples = samples;
  request.max_depth = max_depth;
  request.seed = seed;
  request.reuse = 1;
  return request;
}

// Contribution of paths with a fixed number of bounces, measured with single samples: variance, and mean over
// the channels.
struct Bounce {
  double variance = 0, mean = 0;
};
std::vector<Bounce> by_bounce(int most, int side, int seeds) {
  const auto box = load(sample("cornell-box"));
  std::vector<Bounce> bounces(static_cast<std::size_t>(most) + 1);
  const std::size_t values = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 3;
  std::vector<std::vector<double>> sums(bounces.size(), std::vector<double>(values)), squares = sums;
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<double> before(values);
    for (std::size_t bounce = 0; bounce < bounces.size(); ++bounce) {
      const Picture picture =
          render(box, alone(side, 1, static_cast<int>(bounce) + 1, static_cast<std::uint64_t>(seed)));
      for (std::size_t i = 0; i < values; ++i) {
        const double so_far = double{picture.pixels[i / 3].*kChannels[i % 3]};
        const double brings = so_far - std::exchange(before[i], so_far);
        sums[bounce][i] += brings / seeds;
        squares[bounce][i] += brings * brings / seeds;
      }
    }
  }
  for (std::size_t bounce = 0; bounce < bounces.size(); ++bounce)
    for (std::size_t i = 0; i < values; ++i) {
      const double mean = sums[bounce][i];
      bounces[bounce].mean += mean / static_cast<double>(values);
      bounces[bounce].variance +=
          (squares[bounce][i] - mean * mean) * seeds / (seeds - 1) / static_cast<double>(values);
    }
  return bounces;
}

// Compares fractions of the variance of single samples with the fractions in an independent path tracer
// without roulette. Direct light has 8 %, one bounce 49 to 58 %, two bounces 21 to 26 % and three 9 to 13 %.
// Roulette shifts a few percent to longer paths, and edges in large pixels shift a few to direct light.
TEST(CornellBox, MatchesVarianceByBounce) {
  covers("light-37");
  const std::vector<Bounce> bounces = by_bounce(8, 128, 6);
  double all = 0;
  for (const Bounce& bounce : bounces) all += bounce.variance;
  const auto share = [&](std::size_t bounce) { return bounces[bounce].variance / all; };
  EXPECT_NEAR(share(0), 0.08, 0.08);
  EXPECT_NEAR(share(1), 0.535, 0.125);
  EXPECT_NEAR(share(2), 0.235, 0.105);
  EXPECT_NEAR(share(3), 0.11, 0.08);
}

// Compares paths of 8 bounces with paths of 17. The shorter paths lose 0.37 % of the reflected red light and
// 0.172 % of the red light of the image, which includes the lamp. Cycles (Blender 3.4.1) loses 0.1722 % +-
// 0.0011 %. The ledger assumes the maximum radiance for omitted rays.
TEST(CornellBox, LosesNoMoreLightThanLedger) {
  covers("light-38");
  const auto box = load(sample("cornell-box"));
  const Picture lamp = render(box, alone(96, 64, 0, 1)), cut = render(box, alone(96, 64, 9, 1)),
                whole = render(box, alone(96, 64, 18, 1));
  const double lost = whole.sum() - cut.sum(), reflected = whole.sum() - lamp.sum();
  EXPECT_NEAR(lost / reflected, 0.0037, 0.0003);
  EXPECT_NEAR(lost / whole.sum(), 0.001722, 0.0001);
  EXPECT_GE(cut.stats.omitted.mean(), lost / (96 * 96));
  EXPECT_LT(whole.stats.omitted.mean(), 0.02 * cut.stats.omitted.mean());
}

// Means over the image and their standard errors for 0 to 6 bounces, measured with Cycles (Blender 3.4.1 of
// Debian 12) without any biased option. Generated by `tests/bench/run cycles --bounces --samples 64 --seeds
// 8` (128 x 128 pixels, 8 pairs of seeds).
struct Measured {
  Vec3d mean, error;
};
const std::array<Measured, 7> kCycles{{
    {{0.147916, 0.100825, 0.031422}, {0.000013, 0.000009, 0.000003}},
    {{0.171689, 0.114925, 0.034512}, {0.000016, 0.000012, 0.000004}},
    {{0.183865, 0.121516, 0.035702}, {0.000023, 0.000015, 0.000005}},
    {{0.189724, 0.124490, 0.036122}, {0.000024, 0.000016, 0.000005}},
    {{0.192884, 0.125999, 0.036303}, {0.000025, 0.000017, 0.000005}},
    {{0.194520, 0.126732, 0.036372}, {0.000025, 0.000017, 0.000005}},
    {{0.195424, 0.127114, 0.036403}, {0.000026, 0.000018, 0.000005}},
}};

// Compares path lengths separately, because their errors could cancel in the image.
TEST(CornellBox, MatchesCyclesByPathLength) {
  covers("light-36");
  constexpr int kSide = 128, kSeeds = 6;
  const auto box = load(sample("cornell-box"));
  for (std::size_t bounces = 0; bounces < kCycles.size(); ++bounces) {
    Vec3d sum, squares;
    for (int seed = 0; seed < kSeeds; ++seed) {
      RenderRequest request =
          alone(kSide, 4, static_cast<int>(bounces) + 1, static_cast<std::uint64_t>(seed));
      request.reuse = 16;
      const Picture picture = render(box, request);
      for (std::size_t c = 0; c < 3; ++c) {
        const double mean = picture.sum(kChannels[c]) / (kSide * kSide);
        sum[c] += mean / kSeeds;
        squares[c] += mean * mean / kSeeds;
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double variance = (squares[c] - sum[c] * sum[c]) / (kSeeds - 1),
                   theirs = kCycles[bounces].error[c];
      EXPECT_NEAR(sum[c], kCycles[bounces].mean[c], 3 * std::sqrt(variance + theirs * theirs))
          << bounces << " bounces, channel " << c;
      EXPECT_LT(variance, std::pow(2e-3 * sum[c], 2)) << "the comparison needs a small variance";
    }
  }
}

// Returns the mean squared error of a channel, from pairs of images with different seeds.
double mean_squared_error(const std::shared_ptr<const Scene>& box, int side, int samples, int max_depth,
                          int pairs) {
  double squares = 0;
  for (int pair = 0; pair < pairs; ++pair) {
    const auto seed = static_cast<std::uint64_t>(2 * pair);
    const Picture a = render(box, alone(side, samples, max_depth, seed)),
                  b = render(box, alone(side, samples, max_depth, seed + 1));
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      for (const auto channel : kChannels)
        squares += std::pow(double{a.pixels[i].*channel} - b.pixels[i].*channel, 2) / 2;
  }
  return squares / (3.0 * side * side * pairs);
}

// Returns the slope of the logarithm of the root mean squared error against the logarithm of the sample
// count. Fits counts from `fewest` to `most`, each four times the previous, by least squares.
double slope(const std::shared_ptr<const Scene>& box, int side, int max_depth, int fewest, int most) {
  double x_sum = 0, y_sum = 0, xx = 0, xy = 0, n = 0;
  for (int samples = fewest; samples <= most; samples *= 4, ++n) {
    const int pairs = std::clamp(most / samples / 4, 1, 4);
    const double x = std::log(samples),
                 y = std::log(mean_squared_error(box, side, samples, max_depth, pairs)) / 2;
    x_sum += x;
    y_sum += y;
    xx += x * x;
    xy += x * y;
  }
  return (n * xy - x_sum * y_sum) / (n * xx - x_sum * x_sum);
}

// Direct light has few dimensions and few edges, so it converges fast. With many bounces there are more
// dimensions than are stratified jointly. In very small images, most pixels have edges and few pixels have
// most of the error.
TEST(CornellBox, ConvergesFasterThanIndependentSamples) {
  covers("light-51");
  if (kSanitized) GTEST_SKIP() << "traces 20 million paths";
  const auto box = load(sample("cornell-box"));
  EXPECT_LE(slope(box, 128, 1, 4, 256), -0.70);
  const double all = slope(box, 16, 9, 16, 4096);
  EXPECT_LE(all, -0.48);
  EXPECT_GE(all, -0.60);
  // Single samples of different seeds are independent, so the mean of 64 has 1/64 of the variance.
  const double independent = mean_squared_error(box, 128, 1, 9, 8) / 64,
               stratified = mean_squared_error(box, 128, 64, 9, 1);
  EXPECT_NEAR(independent / stratified, 1.7, 0.4);
}

}  // namespace
}  // namespace orrery::test
