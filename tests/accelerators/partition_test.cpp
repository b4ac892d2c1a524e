#include <cmath>

#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Tests space partitions for typical failures: unbounded duplication of primitives, and cells of equal size
// in scenes of many scales.
namespace orrery::test {
namespace {

// Upper bound on the average references per primitive, for each structure that may reference a primitive more
// than once.
const std::map<std::string, std::size_t> kShares{
    {"octree", 8}, {"kd-median", 3}, {"kd-sah", 3}, {"grid", 16}, {"adaptive-grid", 12}};

std::vector<std::string> sharing_names() {
  std::vector<std::string> names;
  for (const auto& [name, times] : kShares) names.push_back(name);
  return names;
}

Json triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {{"type", "triangle"}, {"vertices", {{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}}};
}
Json sphere(const Vec3d& center, double radius) {
  return {{"type", "sphere"}, {"center", {center.x, center.y, center.z}}, {"radius", radius}};
}

Rays<float> rays_in(double half, int count) {
  Random random(4);
  Rays<float> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back({Vec3f(random.in_cube(1.5 * half)), Vec3f(random.direction())});
  return rays;
}

class Partitions : public StructureTest {
 protected:
  void expect_few_references(const Json& scene, double half) {
    expect_few_references(scene, rays_in(half, 2000));
  }
  void expect_few_references(const Json& scene, const Rays<float>& rays) {
    const auto facts = agree<float>(scene, rays, {1.0f, 1e30f});
    const auto count = static_cast<std::size_t>(load(scene)->primitive_count());
    EXPECT_LE(facts.references, kShares.at(GetParam()) * count + 64);
  }
};

TEST_P(Partitions, LimitsReferencesToDiagonalTriangles) {
  covers("F14");
  Json objects{triangle({-1, -1, -1}, {1, 1, 0.9}, {-0.9, 1, 1})};
  for (int i = 0; i < 200; ++i) objects.push_back(triangle({-1, -1, -1}, {1, 1, 0.001 * i}, {-0.9, 1, 1}));
  expect_few_references(scene_with(objects), 1);
}

TEST_P(Partitions, LimitsReferencesToCoincidentSpheres) {
  covers("F14 F15");
  Json objects{sphere({5, 5, 5}, 0.1)};
  for (int i = 0; i < 1000; ++i) objects.push_back(sphere({1, 2, 3}, 1e-4));
  Rays<float> rays = rays_in(6, 2000);
  for (Ray<float>& ray : rays) ray.direction = Vec3f(safe_normalize(Vec3d(1, 2, 3) - Vec3d(ray.origin)));
  expect_few_references(scene_with(objects), rays);
}

TEST_P(Partitions, HitsSheetsOnSplitPlanes) {
  covers("F15");
  Json objects = Json::array();
  for (int i = -8; i <= 8; ++i)
    for (int k = 0; k < 4; ++k) {
      const double x = i, y = 4 * k - 8;
      objects.push_back(triangle({x, y, -8}, {x, y + 4, -8}, {x, y, 8}));
      objects.push_back(triangle({x, y + 4, -8}, {x, y + 4, 8}, {x, y, 8}));
    }
  const Json scene = scene_with(objects);
  expect_few_references(scene, 8);
  Rays<float> in_plane;
  for (int i = -8; i <= 8; ++i)
    for (int k = -20; k <= 20; ++k) {
      const auto x = static_cast<float>(i), y = static_cast<float>(0.4 * k);
      in_plane.push_back({{x, y, -20}, {0, 0, 1}});
      in_plane.push_back({{-20, y, x}, {1, 0, 0}});
      in_plane.push_back({{x - 0.5f, y, -20}, {0.01f, 0, 1}});
    }
  agree<float>(scene, in_plane, {1e30f});
}

TEST_P(Partitions, ReturnsNearerOfLongAndShortPrimitives) {
  covers("F11");
  Random random(8);
  Json objects = Json::array();
  for (int i = 0; i < 60; ++i) {
    const Vec3d a = random.in_cube(8), along = random.direction() * 12.0, beside = random.direction() * 0.2;
    objects.push_back(triangle(a, a + along, a + beside));
  }
  for (int i = 0; i < 300; ++i) objects.push_back(sphere(random.in_cube(8), 0.2));
  const Json scene = scene_with(objects);
  agree<float>(scene, rays_in(8, 50'000), {1e30f});
  expect_few_references(scene, 8);
}

INSTANTIATE_TEST_SUITE_P(All, Partitions, testing::ValuesIn(sharing_names()), parameter_name);

// Returns a closed mesh of about 10,000 triangles that is 1 m wide, in a ring of long walls that is 1 km
// wide.
Json small_mesh_in_large_ring() {
  Json positions = Json::array(), indices = Json::array();
  constexpr int kRows = 50, kColumns = 100;
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double u = M_PI * row / kRows, v = 2 * M_PI * column / kColumns;
      const double r = 0.5 + 0.05 * std::sin(7 * u) * std::cos(5 * v);
      positions.push_back({r * std::sin(u) * std::cos(v), r * std::cos(u), r * std::sin(u) * std::sin(v)});
    }
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const int a = row * kColumns + column, b = row * kColumns + (column + 1) % kColumns;
      indices.push_back({a, b, a + kColumns});
      indices.push_back({b, b + kColumns, a + kColumns});
    }
  Json objects{{{"type", "mesh"}, {"positions", positions}, {"indices", indices}}};
  for (int i = 0; i < 400; ++i) {
    const double a = 2 * M_PI * i / 400, b = 2 * M_PI * (i + 1) / 400;
    const Vec3d low(500 * std::cos(a), -20, 500 * std::sin(a)),
        next(500 * std::cos(b), 60, 500 * std::sin(b));
    objects.push_back(triangle(low, next, {low.x, 60, low.z}));
  }
  return scene_with(objects);
}

double tests_per_ray(const Json& scene, const std::string& name, const Rays<float>& rays) {
  Structure<float> structure(scene, name);
  structure.closest(rays);
  return static_cast<double>(structure.counts().primitive_tests) / static_cast<double>(rays.size());
}

TEST(AdaptiveGrid, NeedsFewTestsForSmallMeshInLargeScene) {
  covers("F10");
  const Json scene = small_mesh_in_large_ring();
  Random random(9);
  Rays<float> rays;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d from = random.direction() * 3.0, to = random.in_cube(0.5);
    rays.push_back({Vec3f(from), Vec3f(safe_normalize(to - from))});
  }
  const double hierarchy = tests_per_ray(scene, "bvh", rays);
  EXPECT_LE(tests_per_ray(scene, "adaptive-grid", rays), 5 * hierarchy);
  EXPECT_GT(tests_per_ray(scene, "grid", rays), 5 * hierarchy) << "the scene is not hard for a uniform grid";
}

// Expects at most 1.3 times the primitive tests of a bottom-up tree, both for evenly spread triangles and for
// sizes that differ by a factor of 1,000.
TEST(SurfaceAreaHeuristic, StaysNearBottomUpTestCount) {
  const Json scene = small_mesh_in_large_ring();
  Random random(10);
  Rays<float> near, far;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d from = random.direction() * 3.0;
    near.push_back({Vec3f(from), Vec3f(safe_normalize(random.in_cube(0.5) - from))});
    far.push_back({Vec3f(random.in_cube(100)), Vec3f(random.direction())});
  }
  EXPECT_LE(tests_per_ray(scene, "bvh", near), 1.3 * tests_per_ray(scene, "bottom-up", near));
  EXPECT_LE(tests_per_ray(scene, "bvh", far), 1.3 * tests_per_ray(scene, "bottom-up", far));
}

}  // namespace
}  // namespace orrery::test
