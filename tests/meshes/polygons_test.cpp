#include "core/meshes/polygons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/meshes/writers.h"
#include "tests/support/random.h"

// Compares divided polygons with areas and points computed from their outlines.
namespace orrery::test {
namespace {

using Outline = std::vector<std::array<double, 2>>;

// Axes of the plane of a polygon.
struct Plane {
  Vec3d origin, u, v;
  Vec3d at(const std::array<double, 2>& p) const { return origin + u * p[0] + v * p[1]; }
};
const Plane kGround{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

std::string obj_of_polygon(const Outline& outline, const Plane& plane) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < outline.size(); ++i) {
    text += "v " + words(plane.at(outline[i])) + "\n";
    face += " " + std::to_string(i + 1);
  }
  return text + face + "\n";
}

double signed_area(const Outline& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum / 2;
}

// Returns how often the outline goes around a point.
int winding(const Outline& outline, double x, double y) {
  double turned = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double ax = a[0] - x, ay = a[1] - y, bx = b[0] - x, by = b[1] - y;
    turned += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  return static_cast<int>(std::lround(turned / (2 * std::numbers::pi)));
}

// Counts the triangles of the mesh that contain a point of the plane.
int covering(const TriangleMesh& mesh, const Plane& plane, double x, double y) {
  int count = 0;
  for (const Corners& corners : corners_of(mesh)) {
    std::array<std::array<double, 2>, 3> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = corners[k] - plane.origin;
      c[k] = {dot(p, plane.u) / dot(plane.u, plane.u), dot(p, plane.v) / dot(plane.v, plane.v)};
    }
    const auto side = [&](std::size_t a, std::size_t b) {
      return (c[b][0] - c[a][0]) * (y - c[a][1]) - (c[b][1] - c[a][1]) * (x - c[a][0]);
    };
    count += side(0, 1) > 0 && side(1, 2) > 0 && side(2, 0) > 0;
  }
  return count;
}

// Expects that each point inside is in one triangle, and each point outside in none.
void expect_divided(const Outline& outline, const Plane& plane, Random& random) {
  const TriangleMesh mesh = read_mesh(obj_of_polygon(outline, plane));
  ASSERT_EQ(mesh.triangles.size(), outline.size() - 2);
  double area = 0;
  for (const auto& [a, b, c] : corners_of(mesh)) area += length(cross(b - a, c - a)) / 2;
  const double expected = signed_area(outline) * length(cross(plane.u, plane.v));
  EXPECT_NEAR(area, expected, 1e-9 * expected);
  for (int i = 0; i < 100; ++i) {
    const double x = random.between(-2, 2), y = random.between(-2, 2);
    ASSERT_EQ(covering(mesh, plane, x, y), winding(outline, x, y)) << x << ' ' << y;
  }
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(Polygons, CoverStarsInAnyPlane) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Vec3d u = random.direction() * random.magnitude(0.01, 100);
    const Plane plane{random.direction() * 10, u, cross(u, random.direction())};
    Outline star;
    const int corners = 4 + random.below(30);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = random.between(0.1, 2);
      star.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    expect_divided(star, plane, random);
  }
}

// A comb has many reflex corners, a spiral has no corner that sees all others.
TEST(Polygons, CoverCombsAndSpirals) {
  Random random(2);
  Outline comb{{-1.9, -1.5}, {1.9, -1.5}};
  for (int i = 20; i >= 0; --i) {
    comb.push_back({-1.9 + 0.19 * i, 1.5});
    if (i > 0) comb.push_back({-1.9 + 0.19 * i - 0.095, -1.2});
  }
  expect_divided(comb, kGround, random);
  Outline spiral;
  for (int i = 0; i <= 60; ++i) {
    const double angle = 0.2 * i, r = 0.3 + 0.025 * i;
    spiral.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  for (int i = 60; i >= 0; --i) {
    const double angle = 0.2 * i, r = 0.25 + 0.025 * i;
    spiral.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  expect_divided(spiral, kGround, random);
}

// A square with a square hole, connected by an edge that is used in both directions.
TEST(Polygons, LeaveHolesOpen) {
  Random random(3);
  expect_divided({{-1.5, -1.5},
                  {1.5, -1.5},
                  {1.5, 1.5},
                  {-1.5, 1.5},
                  {-1.5, -1.5},
                  {-0.5, -0.5},
                  {-0.5, 0.5},
                  {0.5, 0.5},
                  {0.5, -0.5},
                  {-0.5, -0.5}},
                 kGround, random);
}

TEST(Polygons, KeepConvexFans) {
  const TriangleMesh mesh = read_mesh(obj_of_polygon({{0, 0}, {1, 0}, {1.5, 0.5}, {1, 1}, {0, 1}}, kGround));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygons, ReportCrossing) {
  const TriangleMesh mesh = read_mesh(obj_of_polygon({{0, 0}, {2, 1}, {0, 2}, {1, -1}, {1, 3}}, kGround));
  EXPECT_EQ(mesh.triangles.size(), 3u);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "1 polygons cross themselves; their triangles may overlap");
}

// PLY files may list faces before vertices.
TEST(Polygons, AreDividedInPlyFiles) {
  const TriangleMesh mesh = read_mesh(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 5\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n"
      "5 0 1 2 3 4\n0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n");
  double area = 0;
  for (const auto& [a, b, c] : corners_of(mesh)) area += cross(b - a, c - a).z / 2;
  EXPECT_EQ(area, 2.5);
}

// The time of polygons for which clipping is slow is bounded per file.
TEST(Polygons, KeepFansOfTooManyCorners) {
  Outline spiral;
  for (int i = 0; i < 2500; ++i)
    spiral.push_back({(1 + 0.001 * i) * std::cos(0.02 * i), (1 + 0.001 * i) * std::sin(0.02 * i)});
  for (int i = 2499; i >= 0; --i)
    spiral.push_back({(0.99 + 0.001 * i) * std::cos(0.02 * i), (0.99 + 0.001 * i) * std::sin(0.02 * i)});
  const TriangleMesh mesh = read_mesh(obj_of_polygon(spiral, kGround));
  EXPECT_EQ(mesh.triangles.size(), spiral.size() - 2);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("1 concave polygons have too many corners (limit 4,096"), std::string::npos);
}

}  // namespace
}  // namespace orrery::test
