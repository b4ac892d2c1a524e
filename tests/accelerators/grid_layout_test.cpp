#include "core/accelerators/grid_layout.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/covers.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Cells = std::set<CellIndex>;

template <class T>
Cells visited(const GridLayout<T>& layout, const Ray<T>& ray) {
  Cells cells;
  layout.for_each_along(
      SingleRay<T>::of(ray), RayBoxTester<T>(ray), T(0), std::numeric_limits<T>::infinity(),
      [](T) { return true; }, [&](const CellIndex& i, T, T) { cells.insert(i); });
  return cells;
}

// Returns the cells that the ray touches if every cell is closed and enlarged by `pad` on all sides. Computes
// in long double.
template <class T>
Cells touched(const GridLayout<T>& layout, const Ray<T>& ray, long double pad) {
  Cells cells;
  const auto touches = [&](const CellIndex& i) {
    const Bounds<T> cell = layout.cell(i);
    long double from = 0, to = std::numeric_limits<long double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const long double o = ray.origin[axis], d = ray.direction[axis];
      const long double lo = cell.lo[axis] - pad, hi = cell.hi[axis] + pad;
      if (d == 0) {
        if (o < lo || o > hi) return false;
        continue;
      }
      from = std::max(from, ((d > 0 ? lo : hi) - o) / d);
      to = std::min(to, ((d > 0 ? hi : lo) - o) / d);
    }
    return from <= to;
  };
  for (int z = 0; z < layout.count(2); ++z)
    for (int y = 0; y < layout.count(1); ++y)
      for (int x = 0; x < layout.count(0); ++x)
        if (touches({x, y, z})) cells.insert({x, y, z});
  return cells;
}

// Expects the traversal to visit every cell that the ray touches. It may visit other cells only within
// rounding error of the ray.
template <class T>
void expect_visits(const GridLayout<T>& layout, const Ray<T>& ray) {
  const Cells found = visited(layout, ray);
  const long double magnitude = std::max(layout.box().magnitude(), max_component(abs(ray.origin)));
  const long double pad = 64 * magnitude * static_cast<long double>(std::numeric_limits<T>::epsilon());
  const Cells least = touched(layout, ray, 0), most = touched(layout, ray, pad);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), least.begin(), least.end()));
  EXPECT_TRUE(std::includes(most.begin(), most.end(), found.begin(), found.end()));
}

template <class T>
class GridLayouts : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(GridLayouts, Numbers);

TYPED_TEST(GridLayouts, VisitsExactlyTouchedCells) {
  covers("F12");
  using T = TypeParam;
  const GridLayout<T> layout({Vec3<T>(T(-1)), Vec3<T>(T(1))}, 512);
  ASSERT_EQ(layout.cells(), 512u);
  Random random(1);
  for (int i = 0; i < 100'000 && !testing::Test::HasFailure(); ++i)
    expect_visits<T>(layout, {Vec3<T>(random.in_cube(random.magnitude(0.5, 100))),
                              Vec3<T>(safe_normalize(random.direction()))});
}

TYPED_TEST(GridLayouts, VisitsBothSidesOfPlaneContainingRay) {
  covers("F12");
  using T = TypeParam;
  const GridLayout<T> layout({Vec3<T>(T(0)), Vec3<T>(T(8))}, 512);
  for (int a = 0; a <= 8; ++a)
    for (int b = 0; b <= 8; ++b) {
      const T x = layout.plane(0, a), y = layout.plane(1, b);
      for (const T zero : {T(0), T(-0.0)}) {
        expect_visits<T>(layout, {{x, y, T(-3)}, {zero, zero, T(1)}});
        expect_visits<T>(layout, {{x, y, T(11)}, {zero, zero, T(-1)}});
        expect_visits<T>(layout, {{x, T(-3), y}, {zero, T(1), zero}});
        // A ray in a plane between cells that crosses planes of other axes.
        expect_visits<T>(layout, {{x, y, T(-3)}, {T(0.6), zero, T(0.8)}});
      }
    }
  for (const T way : {T(1), T(-1)}) {  // through the corners of cells
    const T d = way / std::sqrt(T(3));
    expect_visits<T>(layout, {{T(4) - 10 * d, T(4) - 10 * d, T(4) - 10 * d}, {d, d, d}});
  }
  expect_visits<T>(layout, {{T(9), T(4), T(-3)}, {T(0), T(0), T(1)}});  // misses the grid
}

TYPED_TEST(GridLayouts, VisitsCellsOfAxisParallelAndEdgeCrossingRays) {
  covers("F12");
  using T = TypeParam;
  const GridLayout<T> unit({Vec3<T>(T(0)), Vec3<T>(T(1))}, 1000);
  const T x = T(0.49);
  EXPECT_EQ(visited<T>(unit, {{x, x, T(-1)}, {T(0), T(0), T(2)}}).size(), 10u);
  const GridLayout<T> wide({{T(0), T(-16), T(0)}, {T(96), T(0), T(48)}}, 18);  // cells of width 16
  ASSERT_EQ(wide.cells(), 18u);
  expect_visits<T>(wide, {{T(0), T(0), T(0)}, Vec3<T>(safe_normalize(Vec3d(90, -16, 45)))});
}

TYPED_TEST(GridLayouts, VisitsCellsOfBoxesWithZeroExtent) {
  covers("F13");
  using T = TypeParam;
  for (const Vec3<T>& size : {Vec3<T>(1, 1, 0), Vec3<T>(0, 1, 0), Vec3<T>(0, 0, 0)}) {
    const GridLayout<T> layout({Vec3<T>(T(2)), Vec3<T>(T(2)) + size}, 64);
    EXPECT_GE(layout.cells(), 1u);
    const Vec3<T> middle = Vec3<T>(T(2)) + size * T(0.5);
    expect_visits<T>(layout, {middle - Vec3<T>(0, 0, 5), {0, 0, 1}});
    expect_visits<T>(layout, {middle - Vec3<T>(5, 0, 0), {1, 0, 0}});
    EXPECT_FALSE(visited<T>(layout, {middle - Vec3<T>(5, 0, 0), {1, 0, 0}}).empty());
  }
}

}  // namespace
}  // namespace orrery::test
