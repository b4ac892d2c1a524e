#include <gtest/gtest.h>

#include "core/math/hemisphere.h"
#include "tests/support/exhaustive.h"
#include "tests/support/shapes.h"
#include "tests/support/surfaces.h"

// Tests parameters and tangents of every registered shape.
namespace orrery::test {
namespace {

struct SurfaceParameters {
  Vec3d position, geometric, tangent;
  double u, v, s, t;
};

std::vector<SurfaceParameters> parameters_of(const Json& scene_json, const Rays<double>& rays) {
  std::vector<SurfaceParameters> found;
  for_each_surface<double>(*load(scene_json), rays, [&](const auto& hits, const auto& surface, int i) {
    if (hits.primitive[i] != kNoPrimitive)
      found.push_back({surface.position[i], surface.geometric[i], surface.tangent[i], hits.u[i], hits.v[i],
                       surface.u[i], surface.v[i]});
  });
  return found;
}

class ShapeParameters : public testing::TestWithParam<std::string> {};

TEST_P(ShapeParameters, GivesUnitTangentsInSurface) {
  for (const Json& object : shape_samples(GetParam())) {
    const auto found = parameters_of(scene_with(object), rays_at<double>(object, {1, Vec3d()}, 400, 3));
    ASSERT_GT(found.size(), 20u) << object;
    for (const SurfaceParameters& f : found) {
      ASSERT_NEAR(length(f.tangent), 1, 1e-12) << object;
      ASSERT_NEAR(dot(f.tangent, f.geometric), 0, 1e-9) << object;
      ASSERT_TRUE(std::isfinite(f.u) && std::isfinite(f.v) && std::isfinite(f.s) && std::isfinite(f.t));
    }
  }
}

// Between two nearby hits, the hit farther along the tangent has the larger texture coordinate s.
TEST_P(ShapeParameters, IncreasesSAlongTangent) {
  for (const Json& object : shape_samples(GetParam())) {
    Rays<double> rays;
    for (const Ray<double>& ray : rays_at<double>(object, {1, Vec3d()}, exhaustive() ? 300 : 100, 5))
      rays.push_back(ray);
    int compared = 0;
    for (const Ray<double>& ray : rays) {
      const auto here = parameters_of(scene_with(object), {ray});
      if (here.empty()) continue;
      const Vec3d aside = here[0].tangent * 1e-5;
      const auto there = parameters_of(scene_with(object), {{ray.origin + aside, ray.direction}});
      if (there.empty() || dot(there[0].geometric, here[0].geometric) < 0.999) continue;
      const double moved = dot(there[0].position - here[0].position, here[0].tangent);
      const double grown = there[0].s - here[0].s;
      if (std::abs(grown) > 0.5 || std::abs(moved) < 5e-6)
        continue;  // crosses the seam, or the tangent is nearly parallel to the ray
      EXPECT_GT(grown * moved, 0) << object;
      ++compared;
    }
    EXPECT_GT(compared, 10) << object;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShapeParameters, testing::ValuesIn(shape_names()));

TEST(Parameters, MapsSphereToLongitudeAndLatitude) {
  const Json ball = json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 2}");
  const auto at = [&](const Vec3d& from) {
    return parameters_of(scene_with(ball), {{from, safe_normalize(-from)}}).at(0);
  };
  EXPECT_NEAR(at({9, 0, 0}).u, 0, 1e-15);
  EXPECT_NEAR(at({0, 0, -9}).u, 0.25, 1e-15);
  EXPECT_NEAR(at({-9, 0, 1e-9}).u, 0.5, 1e-9);
  EXPECT_NEAR(at({0, 0, 9}).u, 0.75, 1e-15);
  EXPECT_NEAR(at({0, 9, 0}).v, 1, 1e-15);
  EXPECT_NEAR(at({0, -9, 0}).v, 0, 1e-15);
  EXPECT_NEAR(at({5, 5, 0}).v, 0.75, 1e-15);
}

TEST(Parameters, MapsConeToAngleAndHeight) {
  const Json frustum =
      json("{'type': 'cone', 'base': [0, 0, 0], 'top': [0, 0, 2], 'base_radius': 2, 'top_radius': 1}");
  const auto at = [&](const Vec3d& from, const Vec3d& direction) {
    return parameters_of(scene_with(frustum), {{from, direction}}).at(0);
  };
  const auto axes = tangents_of(Vec3d(0, 0, 1));
  EXPECT_NEAR(at(axes.first * 5 + Vec3d(0, 0, 0.5), -axes.first).u, 0, 1e-15);
  EXPECT_NEAR(at(axes.second * 5 + Vec3d(0, 0, 0.5), -axes.second).u, 0.25, 1e-15);
  EXPECT_NEAR(at({5, 0, 0.5}, {-1, 0, 0}).v, 0.25, 1e-15);
  EXPECT_NEAR(at({0.25, 0, 5}, {0, 0, -1}).v, 0.25, 1e-15) << "top cap";
  EXPECT_NEAR(at({0.5, 0, -5}, {0, 0, 1}).v, 0.25, 1e-15) << "base";
}

TEST(Parameters, MapsTorusToTwoAngles) {
  const Json ring = json(
      "{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 0, 1], 'major_radius': 2, 'minor_radius': 0.5}");
  const auto at = [&](const Vec3d& from, const Vec3d& direction) {
    return parameters_of(scene_with(ring), {{from, direction}}).at(0);
  };
  const auto axes = tangents_of(Vec3d(0, 0, 1));
  EXPECT_NEAR(at(axes.first * 5, -axes.first).u, 0, 1e-15);
  EXPECT_NEAR(at(axes.second * 5, -axes.second).u, 0.25, 1e-15);
  EXPECT_NEAR(at({5, 0, 0}, {-1, 0, 0}).v, 0, 1e-15) << "outer equator";
  EXPECT_NEAR(at({2, 0, 5}, {0, 0, -1}).v, 0.25, 1e-15) << "top";
  EXPECT_NEAR(at({0, 0, 0}, {1, 0, 0}).v, 0.5, 1e-15) << "inner equator";
  EXPECT_NEAR(at({2, 0, -5}, {0, 0, 1}).v, 0.75, 1e-15) << "bottom";
}

TEST(Parameters, UsesTextureCoordinatesOfMesh) {
  const Json mesh = json(R"({'type': 'mesh', 'positions': [[0, 0, 0], [4, 0, 0], [0, 4, 0]],
                             'indices': [[0, 1, 2]], 'uvs': [[0.5, 0], [0.5, 1], [0.25, 0]]})");
  const SurfaceParameters f = parameters_of(scene_with(mesh), {{{1, 1, 5}, {0, 0, -1}}}).at(0);
  EXPECT_NEAR(f.u, 0.25, 1e-15);
  EXPECT_NEAR(f.v, 0.25, 1e-15);
  EXPECT_NEAR(f.s, 0.4375, 1e-15);
  EXPECT_NEAR(f.t, 0.25, 1e-15);
  EXPECT_NEAR(f.tangent.y, -1, 1e-15) << "s decreases along +y";
}

TEST(Parameters, RejectsUvCountMismatch) {
  EXPECT_EQ(first_problem(scene_with(json(R"({'type': 'mesh', 'positions': [[0, 0, 0], [4, 0, 0], [0, 4, 0]],
                             'indices': [[0, 1, 2]], 'uvs': [[0.5, 0]]})"))),
            "/objects/0/uvs");
  EXPECT_EQ(first_problem(scene_with(json(R"({'type': 'mesh', 'positions': [[0, 0, 0], [4, 0, 0], [0, 4, 0]],
                             'indices': [[0, 1, 2]], 'uvs': [[0.5, 0], [1, 2, 3], [0, 0]]})"))),
            "/objects/0/uvs/1");
}

}  // namespace
}  // namespace orrery::test
