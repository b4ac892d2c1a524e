#include "core/framing/framing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random.h"

// Projects points with formulas that share no code with the framing, in long double.
namespace orrery::test {
namespace {

using Vec3l = Vec3<long double>;

std::vector<Vec3d> random_points(Random& random, int count, double flatness) {
  std::vector<Vec3d> points;
  const Vec3d centre = Vec3d(random.unit(), random.unit(), random.unit()) * 100;
  for (int i = 0; i < count; ++i)
    points.push_back(centre + Vec3d(random.unit(), random.unit() * flatness, random.unit() * 3));
  return points;
}

// Positions of points in the image: -1 and 1 are its edges.
struct Margins {
  long double left = 1, right = 1, below = 1, above = 1;  // least distances from the edges
  long double gap = 1e9;                                  // least depth of a point
};

Margins margins_of(const std::vector<Vec3d>& points, const Framing& framing, const FramingRequest& request) {
  const Vec3l eye(framing.eye), forward = normalize(Vec3l(framing.look_at) - eye);
  const Vec3l right = normalize(cross(forward, Vec3l(framing.up))), up = cross(right, forward);
  Margins found;
  for (const Vec3d& point : points) {
    const Vec3l at = Vec3l(point) - eye;
    const long double depth = dot(at, forward);
    EXPECT_GT(depth, 0);
    found.gap = std::min(found.gap, depth);
    const long double half =
        request.fov_degrees > 0
            ? depth * std::tan(request.fov_degrees * std::numbers::pi_v<long double> / 360)
            : framing.height / 2.0L;
    const long double x = dot(at, right) / (half * request.aspect), y = dot(at, up) / half;
    found.left = std::min(found.left, 1 + x);
    found.right = std::min(found.right, 1 - x);
    found.below = std::min(found.below, 1 + y);
    found.above = std::min(found.above, 1 - y);
  }
  return found;
}

FramingRequest random_request(Random& random, double fov) {
  constexpr std::array kUps{Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(0, 0, -1)};
  return {.axes = StudioAxes::with_up(kUps[static_cast<std::size_t>(random.below(4))]),
          .from = {360 * random.unit() - 180, 160 * random.unit() - 80},
          .aspect = 0.3 + 3 * random.unit(),
          .fov_degrees = fov,
          .margin = 0.2 * random.unit()};
}

TEST(Framing, HasRightHandedAxes) {
  for (const Vec3d& up :
       {Vec3d(1, 0, 0), Vec3d(-1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, -1, 0), Vec3d(0, 0, 1), Vec3d(0, 0, -1)}) {
    const StudioAxes axes = StudioAxes::with_up(up);
    EXPECT_EQ(axes.up, up);
    EXPECT_EQ(cross(axes.right, axes.up), axes.front);
  }
  EXPECT_EQ(StudioAxes::with_up({0, 0, 1}).front, Vec3d(0, -1, 0));
}

// All points are within the margins, and one pair of opposite margins is exact.
TEST(Framing, IsExact) {
  Random random(1);
  int exact = 0;
  for (int k = 0; k < 300; ++k) {
    const auto points = random_points(random, 1 + random.below(40), k % 3 == 0 ? 0.001 : 2);
    if (points.size() < 3) continue;
    const FramingRequest request = random_request(random, k % 4 == 0 ? 0 : 10 + 100 * random.unit());
    const Margins m = margins_of(points, frame_points(points, request), request);
    const long double asked = 2 * static_cast<long double>(request.margin);
    EXPECT_GE(std::min({m.left, m.right, m.below, m.above}), asked - 1e-9L) << k;
    if (m.gap < 0.4L) continue;  // the camera keeps its distance from the nearest point
    ++exact;
    EXPECT_NEAR(static_cast<double>(std::min(std::max(m.left, m.right), std::max(m.below, m.above)) - asked),
                0, 1e-9)
        << k;
    if (request.fov_degrees == 0) {
      EXPECT_NEAR(static_cast<double>(m.left - m.right), 0, 1e-9);
      EXPECT_NEAR(static_cast<double>(m.below - m.above), 0, 1e-9);
    }
  }
  EXPECT_GT(exact, 200);
}

// The same distance fits at every azimuth, and the fullest of many azimuths nearly touches a margin.
TEST(Framing, FitsFullTurn) {
  Random random(2);
  for (int k = 0; k < 40; ++k) {
    const auto points = random_points(random, 20, 2);
    FramingRequest request = random_request(random, k % 4 == 0 ? 0 : 10 + 60 * random.unit());
    request.fit = Fit::turn;
    const Framing first = frame_points(points, request);
    long double least = 1;
    for (int step = 0; step < 720; ++step) {
      request.from.azimuth += 0.5;
      const Framing framing = frame_points(points, request);
      EXPECT_NEAR(length(framing.eye - framing.look_at), length(first.eye - first.look_at), 1e-9);
      EXPECT_NEAR(length(framing.look_at - first.look_at), 0, 1e-9);
      const Margins m = margins_of(points, framing, request);
      least = std::min({least, m.left, m.right, m.below, m.above});
    }
    const auto asked = 2 * request.margin;
    EXPECT_GE(static_cast<double>(least), asked - 1e-9) << k;
    EXPECT_LT(static_cast<double>(least), asked + 0.001) << k;
  }
}

TEST(Framing, LooksStraightDownAndUp) {
  const std::vector<Vec3d> points{{0, 0, 0}, {2, 1, 0}, {0, 1, 4}};
  for (const double elevation : {90.0, -90.0}) {
    FramingRequest request{.axes = StudioAxes::with_up({0, 1, 0}), .from = {0, elevation}, .fov_degrees = 30};
    const Margins m = margins_of(points, frame_points(points, request), request);
    EXPECT_NEAR(static_cast<double>(std::min(m.below, m.above)), 0.1, 1e-9);
  }
}

// A single point, or several at one place, has a camera 1 m away.
TEST(Framing, AcceptsPoint) {
  const std::vector<Vec3d> points(3, Vec3d(5, 6, 7));
  const StudioAxes axes = StudioAxes::with_up({0, 1, 0});
  for (const double fov : {0.0, 30.0}) {
    const Framing framing = frame_points(points, {.axes = axes, .fov_degrees = fov});
    EXPECT_EQ(framing.look_at, Vec3d(5, 6, 7));
    EXPECT_EQ(framing.eye, Vec3d(5, 6, 8));
  }
}

}  // namespace
}  // namespace orrery::test
