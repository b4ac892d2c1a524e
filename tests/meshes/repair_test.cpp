#include "core/meshes/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/meshes/writers.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using ::testing::HasSubstr;

TEST(SmoothNormals, CreasesCubeAt30DegreesAndRoundsItAt100) {
  TriangleMesh creased = cube();
  smooth_normals(creased, 30);
  EXPECT_EQ(creased.positions.size(), 24u);
  EXPECT_EQ(corners_of(creased), corners_of(cube()));
  for (std::size_t i = 0; i < 24; ++i)
    EXPECT_EQ(max_component(abs(creased.normals[i])), 1) << "a normal along an axis";
  TriangleMesh round = cube();
  smooth_normals(round, 100);
  EXPECT_EQ(round.positions.size(), 8u);
  // Faces are weighted by their angle at the vertex, so the triangulation of a face has no influence.
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_LE(length(round.normals[i] - round.positions[i] / std::sqrt(3.0)), 1e-15);
}

// The cube's faces differ by 90 degrees. A crease angle of exactly 90 degrees does not smooth them.
TEST(SmoothNormals, SeparatesFacesAtExactCreaseAngle) {
  for (const auto& [degrees, vertices] : {std::pair(89.9, 24u), std::pair(90.0, 24u), std::pair(90.1, 8u)}) {
    TriangleMesh mesh = cube();
    smooth_normals(mesh, degrees);
    EXPECT_EQ(mesh.positions.size(), vertices) << degrees;
  }
}

TEST(SmoothNormals, SmoothsAcrossUvSeams) {
  TriangleMesh mesh = cube();
  const std::size_t count = mesh.positions.size();
  for (std::size_t i = 0; i < count; ++i) mesh.positions.push_back(mesh.positions[i]);
  for (std::size_t i = 0; i < 2 * count; ++i) mesh.uvs.push_back({static_cast<double>(i / count), 0});
  for (std::size_t t = 6; t < 12; ++t)
    for (std::uint32_t& i : mesh.triangles[t]) i += 8;
  smooth_normals(mesh, 100);
  EXPECT_EQ(mesh.positions.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_LE(length(mesh.normals[i] - mesh.positions[i] / std::sqrt(3.0)), 1e-15);
}

// The exact normal of the tessellated sphere is the direction from its centre. The discretization error
// decreases with the square of the step.
TEST(SmoothNormals, ConvergesToNormalsOfSphere) {
  double last = 1;
  for (const int n : {8, 16, 32, 64}) {
    TriangleMesh mesh;
    const auto at = [&](int ring, int segment) {
      const double theta = std::numbers::pi * ring / n, phi = std::numbers::pi * (segment % (2 * n)) / n;
      const double across = ring % n == 0 ? 0 : std::sin(theta);
      mesh.positions.push_back({across * std::cos(phi), std::cos(theta), across * std::sin(phi)});
      return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    for (int ring = 0; ring < n; ++ring)
      for (int segment = 0; segment < 2 * n; ++segment) {
        const std::uint32_t a = at(ring, segment), b = at(ring, segment + 1), c = at(ring + 1, segment + 1),
                            d = at(ring + 1, segment);
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    EXPECT_EQ(drop_degenerate(mesh), static_cast<std::size_t>(4 * n));  // at the two poles
    smooth_normals(mesh, 60);
    EXPECT_EQ(mesh.positions.size(), static_cast<std::size_t>(2 * n * (n - 1) + 2));
    double worst = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_NEAR(length(mesh.normals[i]), 1, 1e-15);
      worst = std::max(worst, length(mesh.normals[i] - normalize(mesh.positions[i])));
    }
    const double step = std::numbers::pi / n;
    EXPECT_LT(worst, 0.5 * step * step) << n;
    EXPECT_LT(worst, 0.3 * last) << n;
    last = worst;
  }
}

// Compares each corner of a bumpy surface with the definition: the mean of the facets at its position whose
// normals differ by less than the crease angle, weighted by their angles.
TEST(SmoothNormals, AveragesFacetsWithinCreaseAngle) {
  constexpr std::uint32_t kSide = 20;
  for (const double bump : {0.05, 0.4, 1.5}) {
    Random random(3);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
      mesh.positions.push_back(
          {static_cast<double>(i % kSide), static_cast<double>(i / kSide), bump * random.unit()});
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t a = y * kSide + x;
        mesh.triangles.push_back({a, a + 1, a + kSide + 1});
        mesh.triangles.push_back({a, a + kSide + 1, a + kSide});
      }
    TriangleMesh smooth = mesh;
    smooth_normals(smooth, 30);
    const auto corner = [&](std::size_t t, std::size_t k) {
      return mesh.positions[mesh.triangles[t][k % 3]];
    };
    const auto facet = [&](std::size_t t) {
      return normalize(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    };
    std::size_t several = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3d sum;
        for (std::size_t other = 0; other < mesh.triangles.size(); ++other)
          for (std::size_t j = 0; j < 3; ++j) {
            if (mesh.triangles[other][j] != mesh.triangles[t][k]) continue;
            const Vec3d u = normalize(corner(other, j + 1) - corner(other, j)),
                        v = normalize(corner(other, j + 2) - corner(other, j));
            if (std::acos(std::min(1.0, dot(facet(t), facet(other)))) < std::numbers::pi / 6)
              sum = sum + facet(other) * std::acos(dot(u, v));
            else
              ++several;
          }
        EXPECT_LE(length(smooth.normals[smooth.triangles[t][k]] - normalize(sum)), 1e-12) << t << " " << k;
      }
    EXPECT_EQ(several == 0, bump == 0.05);
  }
}

TEST(SmoothNormals, GivesUnitNormalsWithDegenerateTriangles) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 4, 4}};
  smooth_normals(mesh, 30);
  for (const Vec3d& n : mesh.normals) EXPECT_EQ(n, Vec3d(0, 0, 1));
}

TEST(SmoothNormals, CountsTrianglePairsAtEachPosition) {
  TriangleMesh fan;
  fan.positions.push_back({0, 0, 1});
  for (int i = 0; i <= 100; ++i) fan.positions.push_back({std::cos(0.01 * i), std::sin(0.01 * i), 0});
  for (std::uint32_t i = 1; i <= 100; ++i) fan.triangles.push_back({0, i, i + 1});
  EXPECT_EQ(count_pairs(fan, position_indices_of(fan.positions)), 100u * 100 + 99 * 2 * 2 + 2);
}

TEST(DropUnused, KeepsUsedVerticesInOrder) {
  TriangleMesh mesh;
  mesh.positions = {{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}};
  mesh.normals = {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  mesh.triangles = {{1, 3, 4}};
  drop_unused(mesh);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3d>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
  EXPECT_EQ(mesh.triangles.front(), (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(DropDegenerate, RemovesTrianglesWithoutArea) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1e-300, 0, 0}, {0, 1e-20, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 0, 3}, {0, 3, 4}, {0, 5, 6}, {0, 1, 4}};
  EXPECT_EQ(drop_degenerate(mesh), 3u);
  EXPECT_EQ(mesh.triangles, (decltype(mesh.triangles){{0, 1, 3}, {0, 5, 6}, {0, 1, 4}}));
  EXPECT_EQ(mesh.positions.size(), 7u);
}

}  // namespace
}  // namespace orrery::test
