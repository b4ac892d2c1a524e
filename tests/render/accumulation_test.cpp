#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests sums over samples, and the convergence rate of stratified pixels.
namespace orrery::test {
namespace {

Json even_light(double radiance) {
  Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 900], 'radius': 1}]");
  scene["background"] = {radiance, radiance, radiance};
  return scene;
}

struct Accumulator {
  std::shared_ptr<const Scene> scene;
  PreparedScene prepared;
  SettledPlan plan;
  RenderStats stats;
  std::unique_ptr<Prepared> ready;
  Film film;

  explicit Accumulator(double radiance)
      : scene(load(even_light(radiance))),
        prepared(scene),
        plan(settle(prepared, make_plan(*scene, request()))),
        ready(threads_backend(shared_executor())->prepare(prepared, plan, stats, {})),
        film(kSide, kSide, FilmStorage::sums) {}

  static RenderRequest request() {
    RenderRequest request = in_double(size(kSide, kSide));
    request.technique = "path";
    request.samples = 4096;
    return request;
  }
  static constexpr int kSide = 4;
  static TileView tile(int first_sample, int samples) {
    return {
        .x0 = 0, .y0 = 0, .width = kSide, .height = kSide, .first_sample = first_sample, .samples = samples};
  }
  void render(int first_sample, int samples) {
    const TileView one = tile(first_sample, samples);
    ready->render(std::span(&one, 1), film, stats, {});
  }
  // Returns the mean of the first pixel.
  double mean() const {
    const auto sums = std::make_unique<TileSums>();
    film.take(tile(0, 1), *sums);
    return sums->radiance[0][0] / sums->samples;
  }
};

// Accumulates the maximum sample count of a request, with a value that has no finite binary fraction. Each
// addition has a relative error of at most 2^-53, and 4096 additions have a relative error of at most 4096 *
// 2^-53.
TEST(Accumulation, KeepsConstantAtMaximumSamples) {
  covers("light-10");
  Accumulator accumulator(0.1);
  accumulator.render(0, 1024);
  accumulator.render(1024, 3072);
  EXPECT_NEAR(accumulator.mean() / 0.1, 1, 1e-12);
  EXPECT_EQ(accumulator.film.image(PixelFormat::linear32).linear(0, 0).x, 0.1f);
}

// Adds values of 0.5 to a sum of 5e7, where they would be lost in single precision.
TEST(Accumulation, StaysExactAtHundredMillionSamples) {
  covers("light-10");
  constexpr int kAll = 100'000'000, kLast = 64;
  ASSERT_EQ(float{kAll / 2} + 0.5f, float{kAll / 2});
  Accumulator accumulator(0.5);
  const auto sums = std::make_unique<TileSums>();
  sums->samples = kAll - kLast;
  for (TileSums::Plane& plane : sums->radiance) plane.fill(0.5 * sums->samples);
  accumulator.film.put(Accumulator::tile(0, 1), *sums);
  accumulator.render(kAll - kLast, kLast);
  EXPECT_EQ(accumulator.mean(), 0.5);
  EXPECT_EQ(accumulator.film.image(PixelFormat::linear32).linear(0, 0).x, 0.5f);
}

// Returns the variance of pixel values at `samples` samples, over all gray pixels of images with eight seeds.
template <class Exact>
double variance(const Json& scene, int width, int height, int samples, const Exact& exact) {
  constexpr int kSeeds = 8;
  const auto loaded = load(scene);
  double squares = 0;
  int count = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    RenderRequest request = in_double(size(width, height));
    request.samples = samples;
    request.seed = static_cast<std::uint64_t>(seed);
    const Picture picture = render(loaded, request);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double expected = exact(x, y);
        if (!(expected > 0 && expected < 1)) continue;
        squares += std::pow(double{picture.at(x, y).x} - expected, 2);
        ++count;
      }
  }
  return squares / count;
}

Json seen_from_above(Json scene, double height) {
  scene["camera"] = {{"type", "orthographic"},
                     {"eye", {0, 9, 0}},
                     {"look_at", {0, 0, 0}},
                     {"up", {0, 0, -1}},
                     {"height", height}};
  return scene;
}

// At an edge, variance is proportional to n^-1.5 for n samples (Mitchell, "Consequences of Stratified
// Sampling in Graphics", SIGGRAPH 1996).
TEST(Stratification, ReducesVarianceAsPower3Over2AtEdges) {
  covers("light-6");
  constexpr int kWidth = 64, kHeight = 16;
  constexpr double kSlope = 0.1871, kAt = 0.037;
  // An image of 64 x 16 pixels of 1 m, white below the line y = slope x + at.
  Json scene =
      seen_from_above(scene_of("[]", "{'ambient': [1, 1, 1], 'materials': {'white': {'ka': 1}}}"), kHeight);
  scene["objects"] = Json::array(
      {{{"type", "triangle"},
        {"vertices", {{-100, 0, -(-100 * kSlope + kAt)}, {100, 0, -(100 * kSlope + kAt)}, {0, 0, 1000}}},
        {"material", "white"}}});
  const auto below = [](double t) { return t <= 0 ? 0 : t < 1 ? t * t / 2 : t - 0.5; };
  const auto coverage = [&](int x, int y) {
    const double bottom = kHeight / 2 - 1 - y, left = x - kWidth / 2;
    return (below(kSlope * (left + 1) + kAt - bottom) - below(kSlope * left + kAt - bottom)) / kSlope;
  };
  const double few = variance(scene, kWidth, kHeight, 4, coverage),
               many = variance(scene, kWidth, kHeight, 1024, coverage);
  EXPECT_NEAR(std::log(many / few) / std::log(256), -1.5, 0.1);
}

// For smooth radiance, variance is proportional to n^-2 with one random point per cell. With scrambled nets
// the variance is proportional to n^-3 log n (Owen, "Scrambled Net Variance for Integrals of Smooth
// Functions", 1997).
TEST(Stratification, ReducesVarianceFasterThanPower2IfSmooth) {
  covers("light-6");
  constexpr int kSide = 8;
  const Json scene = seen_from_above(
      scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
               "{'lights': [{'type': 'point', 'position': [0.3, 1.5, 0.4], 'attenuation': [0, 0, 1]}]}"),
      4);
  // Gauss-Legendre quadrature with five points in each direction.
  const std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                 0.9061798459386640},
      weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
             0.2369268850561891};
  const auto mean = [&](int x, int y) {
    double sum = 0;
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        const Vec3d to =
            Vec3d(0.3, 1.5, 0.4) - Vec3d((x + 0.5 + at[i] / 2) / 2 - 2, 0, (y + 0.5 + at[j] / 2) / 2 - 2);
        sum += weight[i] * weight[j] / 4 * to.y / std::pow(dot(to, to), 1.5);
      }
    return sum;
  };
  const double few = variance(scene, kSide, kSide, 4, mean), many = variance(scene, kSide, kSide, 256, mean);
  EXPECT_NEAR(std::log(many / few) / std::log(64), -2.95, 0.15);
}

}  // namespace
}  // namespace orrery::test
