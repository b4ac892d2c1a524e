#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "tests/support/covers.h"
#include "tests/support/tracing.h"

// Tests closed rooms whose radiance has a closed form, by path length, and the effect of Russian roulette.
namespace orrery::test {
namespace {

RenderRequest alone(int max_depth, std::uint64_t seed = 0) {
  RenderRequest request;
  request.technique = "path";
  request.max_depth = max_depth;
  request.reuse = 1;
  request.seed = seed;
  return request;
}
Ray<double> from_to(const Vec3d& from, const Vec3d& to) { return {from, safe_normalize(to - from)}; }

// Sums over independent paths along one ray.
struct Moments {
  double sum = 0, squares = 0, fourth = 0, centre;  // sums of powers of differences from `centre`
  int count = 0;
  explicit Moments(double expected) : centre(expected) {}
  void add(double value) {
    const double d = value - centre;
    sum += d;
    squares += d * d;
    fourth += d * d * d * d;
    ++count;
  }
  double mean() const { return centre + sum / count; }
  double variance() const { return squares / count - sum / count * (sum / count); }
  double error() const { return std::sqrt(variance() / count); }
  double error_of_variance() const { return std::sqrt((fourth / count - variance() * variance()) / count); }
};

// Traces `batches` batches of the same ray. Returns the mean number of rays per path, without the camera ray.
template <class Visit>
double trace_paths(const Json& scene, const Ray<double>& ray, int max_depth, int batches,
                   const Visit& visit) {
  const auto loaded = load(scene);
  const std::vector<Ray<double>> rays(kBatch, ray);
  double reflected = 0;
  for (int batch = 0; batch < batches; ++batch) {
    Tracing tracing(loaded, alone(max_depth, static_cast<std::uint64_t>(batch)));
    for (const TraceOutput& answer : tracing.trace(rays)) visit(answer.radiance.x);
    for (const std::uint64_t n : tracing.counts().rays.reflected) reflected += static_cast<double>(n);
  }
  return reflected / (batches * double{kBatch});
}

// Number of rays after the camera ray, at most `most`. The first ray is always traced, and each later ray
// with probability rho. Mean and variance follow from P(N >= k) = rho^(k-1).
struct Survivors {
  double mean = 0, variance = 0;
  Survivors(double rho, int most) {
    double squares = 0, chance = 1;
    for (int k = 1; k <= most; ++k, chance *= rho) {
      mean += chance;
      squares += (2 * k - 1) * chance;
    }
    variance = squares - mean * mean;
  }
};

// Walls emit 1, reflect rho, and are found only by BSDF sampling. From the second vertex on, a path of
// throughput beta = rho^2 survives with probability sqrt(beta) = rho. The throughput of surviving paths is
// rho again. Each later ray adds rho, so the radiance of N rays is 1 + rho N. Without a depth limit, the mean
// of the radiance is 1 / (1 - rho), and the variance is rho^3 / (1 - rho)^2.
TEST(ClosedRoom, MatchesRouletteMeanVarianceAndRayCount) {
  covers("R2 light-12");
  constexpr int kBatches = 98, kDepth = 32;
  for (const double rho : {0.5, 0.9}) {
    Json room = scene_of("[{'type': 'box', 'min': [-1, -2, -3], 'max': [3, 2, 1]}]",
                         "{'materials': {'white': {'emission': [1, 1, 1]}}}");
    room["materials"]["white"]["kd"] = rho;
    const Survivors expected(rho, kDepth);
    if (rho == 0.5) {
      EXPECT_NEAR(expected.variance, rho / ((1 - rho) * (1 - rho)), 1e-6);
    }
    Moments found(1 + rho * expected.mean);
    const double rays = trace_paths(room, from_to(Vec3d(0.1, 0.2, 0.3), Vec3d(1, 0.4, -0.5)), kDepth,
                                    kBatches, [&](double radiance) { found.add(radiance); });
    EXPECT_NEAR(found.mean(), 1 + rho * rays, 1e-9) << "each ray adds rho";
    EXPECT_NEAR(found.mean(), 1 + rho * expected.mean, 4 * found.error()) << rho;
    EXPECT_NEAR(found.variance() / (rho * rho * expected.variance), 1, 0.03) << rho;
    EXPECT_NEAR(rays, expected.mean, 4 * found.error() / rho) << rho;
  }
}

// The ledger contains the throughput of paths that reach depth D. Each of these paths has throughput rho, and
// the mean over all paths is rho^D. The omitted continuation would have found rho / (1 - rho) per unit of
// throughput.
TEST(ClosedRoom, RecordsCutThroughputInLedger) {
  covers("light-38");
  for (const double rho : {0.5, 0.8})
    for (const int depth : {1, 4, 8}) {
      Json room = scene_of("[{'type': 'box', 'min': [-1, -2, -3], 'max': [3, 2, 1]}]",
                           "{'materials': {'white': {'emission': [1, 1, 1]}}}");
      room["materials"]["white"]["kd"] = rho;
      const auto loaded = load(room);
      const std::vector<Ray<double>> rays(kBatch, from_to(Vec3d(0.1, 0.2, 0.3), Vec3d(1, 0.4, -0.5)));
      Moments cut(std::pow(rho, depth)), whole(1 / (1 - rho));
      for (std::uint64_t seed = 0; seed < 32; ++seed)
        for (const TraceOutput& answer : Tracing(loaded, alone(depth, seed)).trace(rays)) {
          cut.add(answer.cut);
          whole.add(answer.radiance.x + answer.cut * rho / (1 - rho));
        }
      EXPECT_NEAR(cut.mean(), std::pow(rho, depth), 4 * cut.error() + 1e-12) << depth;
      EXPECT_NEAR(whole.mean(), 1 / (1 - rho), 4 * whole.error() + 1e-12) << depth;
    }
}

// A dome of radius 1 over a floor. From any point of the dome, floor and dome each have form factor 1/2. From
// the floor, only the dome is visible. Both emit 1 and have different reflectances.
TEST(ClosedRoom, MatchesExchangeBetweenDomeAndFloor) {
  covers("light-13");
  const Json room = scene_of(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'dome'},"
      " {'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': 1, 'material': 'floor'}]",
      "{'materials': {'dome': {'type': 'lambert', 'reflectance': 0.8, 'emission': [1, 1, 1]},"
      "               'floor': {'type': 'lambert', 'reflectance': 0.2, 'emission': [1, 1, 1]}}}");
  const Vec3d eye(0.1, 0.2, 0.5), to_floor(-0.3, 0.5, 0);
  const std::array to_dome{Vec3d(0.6, 0, 0.8), safe_normalize(Vec3d(-1, 0.3, 0.05))};
  double dome = 1, floor = 1;
  for (int depth = 1; depth <= 32; ++depth) {
    dome = 1 + 0.8 * (0.5 * dome + 0.5 * std::exchange(floor, 1 + 0.2 * dome));
    if (depth > 1 && depth < 32) continue;
    const double relative = depth == 1 ? 4e-4 : 1e-3;  // standard error, with roulette from the second vertex
    const auto expect = [&](const Vec3d& to, double expected) {
      const Estimate found = estimate_alone(room, eye, to, depth, depth == 1 ? 64 : 512);
      EXPECT_NEAR(found.mean, expected, 4 * found.error()) << depth;
      EXPECT_LT(found.error(), relative * expected) << depth;
    };
    expect(to_floor, floor);
    for (const Vec3d& to : to_dome) expect(to, dome);
  }
  EXPECT_NEAR(dome, 1.4 / 0.52, 1e-7);
  EXPECT_NEAR(floor, 1 + 0.2 * dome, 1e-7);
}

// A disk lamp replaces a tenth of the area of a sphere. From each point of the wall, the form factor of the
// lamp is 0.1, and the form factor of the wall is 0.9. From the lamp only the wall is visible. The radiance
// after each reflection is wall' = rho (0.9 wall + 0.1 lamp), lamp' = rho wall.
TEST(ClosedRoom, MatchesEachReflectionInSphere) {
  covers("light-14");
  const Json room = scene_of(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'wall'},"
      " {'type': 'disk', 'center': [0, 0, 0.8], 'normal': [0, 0, 1], 'radius': 0.6, 'material': 'lamp'}]",
      "{'materials': {'wall': {'type': 'lambert', 'reflectance': 0.5},"
      "               'lamp': {'type': 'lambert', 'reflectance': 0.5, 'emission': [10, 10, 10]}}}");
  const auto loaded = load(room);
  constexpr int kBatches = 24;
  for (const Vec3d& to : {Vec3d(0, 0.01, -1), Vec3d(1, 0, 0.05), Vec3d(-0.5, 0.5, 0.6)}) {
    const std::vector<Ray<double>> rays(kBatch, from_to(Vec3d(0.2, 0.1, -0.1), safe_normalize(to)));
    double wall = 0, lamp = 10;
    for (int bounces = 1; bounces <= 6; ++bounces) {
      wall = 0.5 * (0.9 * wall + 0.1 * std::exchange(lamp, 0.5 * wall));
      Moments found(wall);
      for (std::uint64_t seed = 0; seed < kBatches; ++seed) {
        const auto longer = Tracing(loaded, alone(bounces, seed)).trace(rays),
                   shorter = Tracing(loaded, alone(bounces - 1, seed)).trace(rays);
        for (std::size_t i = 0; i < longer.size(); ++i)
          found.add(longer[i].radiance.x - shorter[i].radiance.x);
      }
      EXPECT_NEAR(found.mean(), wall, 4 * found.error() + 1e-12) << bounces;
      EXPECT_LT(found.error(), 0.05 * wall) << bounces;
    }
  }
}

// A point light at the centre of a sphere of radius 1 causes a radiance of rho on its wall. Each reflection
// has rho times the radiance of the previous one.
TEST(ClosedRoom, MatchesIntegratingSphere) {
  covers("R4 light-15");
  constexpr int kDepth = 9;
  for (const auto& [rho, expected] : {std::pair{0.8, 3.4631}, {0.9, 5.5132}}) {
    Json room = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]",
                         "{'lights': [{'type': 'point', 'position': [0, 0, 0], 'attenuation': [0, 0, 1]}],"
                         " 'materials': {'white': {'type': 'lambert', 'kd': null}}}");
    room["materials"]["white"]["reflectance"] = rho;
    const Survivors survivors(rho, kDepth - 1);
    ASSERT_NEAR(rho * (1 + rho * survivors.mean), expected, 1e-4);
    Moments found(expected);
    const double rays = trace_paths(room, from_to(Vec3d(0.3, -0.2, 0.1), Vec3d(0.4, 0.7, -0.2)), kDepth, 64,
                                    [&](double radiance) { found.add(radiance); });
    EXPECT_NEAR(found.mean(), expected, 4 * found.error()) << rho;
    EXPECT_LT(found.error(), 0.01) << rho;
    // Rays of the last depth add no light, because no surface emits.
    EXPECT_NEAR(found.variance() / (std::pow(rho, 4) * survivors.variance), 1, 0.05) << rho;
    EXPECT_NEAR(rays, Survivors(rho, kDepth).mean, 4 * found.error() / (rho * rho) * 1.3) << rho;
  }
}

}  // namespace
}  // namespace orrery::test
