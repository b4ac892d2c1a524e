#include <cmath>

#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Rays from within a closed mesh, aimed at its vertices and edge midpoints, must not escape.
namespace orrery::test {
namespace {

struct Ball {
  std::vector<Vec3d> positions;
  std::vector<std::array<int, 3>> triangles;
};

// Returns a ball of radius 2 in 24 rows and 48 columns of faces, with 2,208 triangles.
Ball ball_around(const Vec3d& middle) {
  constexpr int kRows = 24, kColumns = 48;
  Ball ball;
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double u = M_PI * row / kRows, v = 2 * M_PI * column / kColumns;
      const bool pole = row == 0 || row == kRows;
      const Vec3d at = pole ? Vec3d(0, row == 0 ? 2 : -2, 0)
                            : Vec3d(std::sin(u) * std::cos(v), std::cos(u), std::sin(u) * std::sin(v)) * 2.0;
      ball.positions.push_back(middle + at);
    }
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const int a = row * kColumns + column, b = row * kColumns + (column + 1) % kColumns;
      if (row > 0) ball.triangles.push_back({a, b, a + kColumns});
      if (row + 1 < kRows) ball.triangles.push_back({b, b + kColumns, a + kColumns});
    }
  return ball;
}

Json scene_of_ball(const Ball& ball) {
  Json positions = Json::array(), indices = Json::array();
  for (const Vec3d& p : ball.positions) positions.push_back(numbers(p));
  for (const auto& t : ball.triangles) indices.push_back(t);
  return scene_with({{"type", "mesh"}, {"positions", positions}, {"indices", indices}});
}

// Returns rays towards vertices and edge midpoints. Every other group of 16 rays has separate origins. The
// rays of each remaining group share an origin, so that packets can traverse them together.
template <class T>
Rays<T> aimed(const Ball& ball, const Vec3d& middle, int count) {
  Random random(12);
  Rays<T> rays;
  Vec3d from;
  for (int i = 0; i < count; ++i) {
    if (i / 16 % 2 == 0 || i % 16 == 0) from = middle + random.in_cube(0.57);
    const auto& triangle =
        ball.triangles[i / 16 % 2 == 0 ? random.below(ball.triangles.size())
                                       : static_cast<std::size_t>(i / 32) % ball.triangles.size()];
    const auto k = random.below(3);
    const Vec3<T> a(ball.positions[static_cast<std::size_t>(triangle[k])]);
    const Vec3<T> b(ball.positions[static_cast<std::size_t>(triangle[(k + 1) % 3])]);
    const Vec3<T> at = random.below(2) ? a : (a + b) * T(0.5);
    const Vec3<T> start(from);
    rays.push_back({start, Vec3<T>(safe_normalize(Vec3d(at) - Vec3d(start)))});
  }
  return rays;
}

class Watertight : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  void expect_no_leak(const Vec3d& middle, int count) {
    const Ball ball = ball_around(middle);
    Structure<T> structure(scene_of_ball(ball), GetParam());
    const Rays<T> rays = subsample_rays(aimed<T>(ball, middle, count));
    int out = 0;
    for (const auto& hit : structure.closest(rays)) out += !hit.met();
    EXPECT_EQ(out, 0) << "of " << rays.size() << " rays";
    for (const char occluded : structure.occluded(rays, std::numeric_limits<T>::infinity())) out += !occluded;
    EXPECT_EQ(out, 0) << "of " << rays.size() << " shadow rays";
  }
  // Returns the ray count: a million for the default structure, 50,000 for the others.
  static int rays() { return GetParam() == "bvh" ? 1'000'000 : 50'000; }
};

TEST_P(Watertight, LeaksNoRaysAroundOrigin) {
  covers("A12 A27 A28");
  expect_no_leak<float>({}, rays());
  expect_no_leak<double>({}, rays());
}

// The position is from Embree's watertightness test.
TEST_P(Watertight, LeaksNoRaysFarFromOrigin) {
  covers("A12 A27 A28");
  expect_no_leak<float>({148376, 1234, -223423}, rays());
  expect_no_leak<double>({148376, 1234, -223423}, rays());
}

std::vector<std::string> fast_names() {
  std::vector<std::string> names;
  for (const std::string& name : accelerator_names())
    if (name != "list" && name != "boxes" && name != "oriented-boxes") names.push_back(name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, Watertight, testing::ValuesIn(fast_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
