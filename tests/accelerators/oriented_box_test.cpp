#include "core/accelerators/oriented_box.h"

#include <gtest/gtest.h>

#include "tests/support/covers.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Hull = std::vector<HullTriangle>;

OrientedBox<double> box_of(const Hull& hull) {
  SurfaceMoments moments;
  for (const auto& triangle : hull) moments.add(triangle);
  return OrientedBox<double>::around(principal_axes(moments), hull);
}

// Returns the smallest measure among 1,000 bounding boxes of `hull` with random axes.
template <class Measure>
double best_of_random(const Hull& hull, const Measure& measure) {
  Random random(11);
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const Vec3d x = random.direction(), y = safe_normalize(cross(x, random.direction()));
    best = std::min(best, measure(OrientedBox<double>::around({x, y, cross(x, y)}, hull)));
  }
  return best;
}

double volume(const OrientedBox<double>& box) { return box.volume(); }
double area(const OrientedBox<double>& box) { return box.half_area(); }

void expect_orthonormal(const std::array<Vec3d, 3>& axes) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(axes[i], axes[j]), i == j ? 1 : 0, 1e-12);
}

void expect_inside(const OrientedBox<double>& box, const Hull& hull) {
  double magnitude = 0;
  for (const auto& triangle : hull)
    for (const Vec3d& p : triangle) magnitude = std::max(magnitude, max_component(abs(p)));
  const double pad = 64 * std::numeric_limits<double>::epsilon() * magnitude;
  for (const auto& triangle : hull)
    for (const Vec3d& p : triangle)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = dot(box.axes[axis], p - box.center);
        EXPECT_GE(along, box.box.lo[axis] - pad);
        EXPECT_LE(along, box.box.hi[axis] + pad);
      }
}

Vec3d turned(const Vec3d& p) {  // rotated about z, then about x
  const double a = 0.5, b = 0.8;
  const Vec3d q(std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z);
  return {q.x, std::cos(b) * q.y - std::sin(b) * q.z, std::sin(b) * q.y + std::cos(b) * q.z};
}
Hull turned(Hull hull) {
  for (auto& triangle : hull)
    for (Vec3d& corner : triangle) corner = turned(corner);
  return hull;
}

TEST(OrientedBox, FitsCubeTightly) {
  covers("F7");
  const Boundsd cube = Boundsd::around({}, Vec3d(1));
  EXPECT_NEAR(box_of(sides_of(cube)).volume(), 8, 1e-9);
}

TEST(OrientedBox, IsPreferredOnlyIfSmaller) {
  covers("F7");
  Random random(3);
  int taken = 0;
  for (int i = 0; i < 1000; ++i) {
    Hull hull;
    for (int k = 0; k < 4; ++k) hull.push_back({random.in_cube(1), random.in_cube(1), random.in_cube(0.1)});
    Boundsd box;
    for (const auto& triangle : hull)
      for (const Vec3d& corner : triangle) box.include(corner);
    const OrientedBox<double> oriented = box_of(hull);
    if (!oriented_pays(oriented, box)) continue;
    ++taken;
    const Vec3d size = box.hi - box.lo;
    EXPECT_LE(oriented.volume(), size.x * size.y * size.z);
  }
  EXPECT_GT(taken, 20);
}

TEST(OrientedBox, FitsRotatedSlab) {
  covers("F7");
  const Hull slab = turned(sides_of(Boundsd::around({}, {4, 1, 0.25})));
  EXPECT_NEAR(box_of(slab).volume(), 8, 1e-9);
}

// Axes fitted to vertices would turn towards the clusters of vertices in two corners. Axes fitted to area
// must not.
TEST(OrientedBox, IgnoresTessellationDensity) {
  covers("F8");
  Hull rectangle{{Vec3d(0, 0, 0), Vec3d(4, 0, 0), Vec3d(4, 1, 0)},
                 {Vec3d(0, 0, 0), Vec3d(4, 1, 0), Vec3d(0, 1, 0)}};
  Hull cube = sides_of(Boundsd::around({}, Vec3d(1)));
  for (int i = 0; i < 1000; ++i) {
    for (const Vec3d& corner : {Vec3d(0, 0, 0), Vec3d(4, 1, 0)})
      rectangle.push_back({corner, corner, corner});
    for (const Vec3d& corner : {Vec3d(-1), Vec3d(1)}) cube.push_back({corner, corner, corner});
  }
  EXPECT_LE(area(box_of(turned(rectangle))), 1.1 * best_of_random(turned(rectangle), area));
  EXPECT_LE(volume(box_of(cube)), 1.1 * best_of_random(cube, volume));
}

TEST(OrientedBox, EnclosesDegenerateHulls) {
  covers("F9");
  const Vec3d p(3, -2, 5);
  const Hull point{{p, p, p}}, line{{p, p + Vec3d(1, 2, 3), p + Vec3d(2, 4, 6)}};
  const Hull plane{{p, p + Vec3d(1, 2, 3), p + Vec3d(-2, 1, 0)}};
  for (const Hull& hull : {point, line, plane}) {
    SurfaceMoments moments;
    for (const auto& triangle : hull) moments.add(triangle);
    expect_orthonormal(principal_axes(moments));
    expect_inside(box_of(hull), hull);
  }
}

TEST(OrientedBox, EnclosesItsHull) {
  covers("F9");
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3d at = random.in_cube(random.magnitude(1e-3, 1e6));
    Hull hull;
    for (int k = 0; k < 5; ++k)
      hull.push_back({at + random.in_cube(1), at + random.in_cube(2), at + random.in_cube(1)});
    expect_inside(box_of(hull), hull);
  }
}

}  // namespace
}  // namespace orrery::test
