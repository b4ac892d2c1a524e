#include "core/raster/tessellate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/plan/plan.h"
#include "tests/support/pictures.h"

// Tests the distance of tessellated shapes from their surfaces, in pixels.
namespace orrery::test {
namespace {

constexpr std::size_t kEnough = 8'000'000;  // triangles

RenderRequest within(double error) {
  RenderRequest request = size(400, 300);
  request.technique = "phong";
  request.tessellation_error = error;
  return request;
}

// Returns the largest distance of edges and triangles from the surface, in pixels, where depth(point) metres
// is the distance of a point inside its surface.
template <class Depth>
double largest_error(const Tessellation& surfaces, const Plan& plan, const Depth& depth) {
  double largest = 0;
  for (const Tessellation::Triangle& triangle : surfaces.triangles) {
    const auto at = [&](std::size_t i) { return surfaces.vertices[triangle.vertices[i % 3]].position; };
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d point = i < 3 ? (at(i) + at(i + 1)) * 0.5 : (at(0) + at(1) + at(2)) / 3;
      const double pixel =
          2 * plan.frame.half_extent / plan.height * -dot(point - plan.frame.eye, plan.frame.back);
      largest = std::max(largest, depth(point) / pixel);
    }
  }
  return largest;
}

TEST(Tessellate, StaysWithinErrorOnCurvedShapes) {
  for (const double error : {4.0, 0.25, 0.02})
    for (const double radius : {0.1, 1.0, 3.0}) {
      SCOPED_TRACE(testing::Message() << error << " pixels, radius " << radius);
      const Json sphere = {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", radius}};
      const Json cylinder = {
          {"type", "cylinder"}, {"base", {0, -1, 0}}, {"top", {0, 1, 0}}, {"radius", radius}};
      const auto check = [&](const Json& object, const auto& depth) {
        const auto scene = load(scene_with(object));
        const Plan plan = make_plan(*scene, within(error));
        const Tessellation surfaces = tessellate(*scene, plan, kEnough);
        const double largest = largest_error(surfaces, plan, depth);
        EXPECT_LE(largest, surfaces.error * (1 + 1e-9));
        EXPECT_LE(surfaces.error, error);
        EXPECT_GT(surfaces.error, 0);
      };
      const double slant = std::hypot(2, 0.5 * radius);
      const Json cone = {{"type", "cone"},
                         {"base", {0, -1, 0}},
                         {"top", {0, 1, 0}},
                         {"base_radius", radius},
                         {"top_radius", radius / 2}};
      const Json torus = {{"type", "torus"},
                          {"center", {0, 0, 0}},
                          {"axis", {0, 1, 0}},
                          {"major_radius", radius * 0.7},
                          {"minor_radius", radius * 0.3}};
      Json nurbs = {{"type", "nurbs"},         {"degree_u", 2},
                    {"degree_v", 1},           {"knots_u", {0, 0, 0, 1, 1, 1}},
                    {"knots_v", {0, 0, 1, 1}}, {"weights", {1, std::sqrt(0.5), 1, 1, std::sqrt(0.5), 1}}};
      for (const double y : {-1.0, 1.0})  // a quarter of the cylinder
        for (const auto& [x, z] : {std::pair{1, 0}, {1, 1}, {0, 1}})
          nurbs["points"].push_back({x * radius, y, z * radius});
      check(nurbs, [&](const Vec3d& p) { return radius - std::hypot(p.x, p.z); });
      check(sphere, [&](const Vec3d& p) { return radius - length(p); });
      check(cylinder, [&](const Vec3d& p) {  // the caps are exact
        return std::abs(p.y) < 1 ? radius - std::hypot(p.x, p.z) : 0;
      });
      check(cone, [&](const Vec3d& p) {
        return std::abs(p.y) < 1 ? (radius * (0.75 - 0.25 * p.y) - std::hypot(p.x, p.z)) * 2 / slant : 0;
      });
      check(torus, [&](const Vec3d& p) {
        return std::abs(radius * 0.3 - std::hypot(std::hypot(p.x, p.z) - radius * 0.7, p.y));
      });
    }
}

TEST(Tessellate, RejectsTooManyTriangles) {
  const auto scene = load(scene_with(json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}")));
  const Plan plan = make_plan(*scene, within(0.25));
  EXPECT_NO_THROW(tessellate(*scene, plan, kEnough));
  EXPECT_THROW(tessellate(*scene, plan, 100), InputError);
}

}  // namespace
}  // namespace orrery::test
