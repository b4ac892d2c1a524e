#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/lighting/texture_coordinates.h"
#include "core/math/hemisphere.h"
#include "core/params/params.h"
#include "core/textures/mapping.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

TextureMapping mapping(const char* text) {
  TextureMapping found;
  read_document(parse_document(json(std::string("{'mapping': ") + text + "}").dump()),
                [&](Params& p) { found = read_mapping(p); });
  return found;
}

Vec3d at(const TextureMapping& mapping, const Vec3d& p) {
  return MappingOf<double>(mapping).coordinates(p, {1, 0, 0}, {0, 1, 0}).at;
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-13) {
  EXPECT_LT(length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

TEST(TextureMapping, ProjectsOntoPlanes) {
  const TextureMapping plane =
      mapping("{'type': 'planar', 'origin': [1, 2, 3], 'u_edge': [2, 0, 0], 'v_edge': [0, 0, -4]}");
  expect_near(at(plane, {1, 9, 3}), {0, 0, 0});
  expect_near(at(plane, {3, -5, -1}), {1, 1, 0});
  expect_near(at(plane, {2, 0, 2}), {0.5, 0.25, 0});
}

TEST(TextureMapping, MeasuresSolidCoordinatesInUnitsOfTheirSize) {
  const TextureMapping solid = mapping("{'type': 'solid', 'origin': [1, 0, 0], 'size': 0.5}");
  expect_near(at(solid, {2, 1, -0.25}), {2, 2, -0.5});
}

TEST(TextureMapping, TurnsTheAxisOfTheTexture) {
  for (const char* axis : {"[0, 1, 0]", "[1, 0, 0]", "[0.3, -0.8, 0.4]", "[0, -1, 0]", "[1e-9, -1, 0]"}) {
    const TextureMapping solid = mapping((std::string("{'type': 'solid', 'axis': ") + axis + "}").c_str());
    expect_near(at(solid, solid.y * 2), {0, 2, 0});
    EXPECT_NEAR(dot(solid.x, solid.z), 0, 1e-12) << axis;
    EXPECT_NEAR(length(solid.x), 1, 1e-12) << axis;
    EXPECT_NEAR(dot(cross(solid.x, solid.y), solid.z), 1, 1e-12) << axis;
  }
}

TEST(TextureMapping, MeasuresAnglesOnSpheres) {
  const TextureMapping ball = mapping("{'type': 'spherical', 'origin': [0, 1, 0]}");
  for (const double latitude : {-1.2, -0.3, 0.0, 0.7, 1.5})
    for (const double turn : {0.01, 0.2, 0.5, 0.8, 0.99}) {
      const double angle = 2 * kPi * turn;
      const Vec3d p(std::cos(latitude) * std::cos(angle), std::sin(latitude),
                    -std::cos(latitude) * std::sin(angle));
      expect_near(at(ball, p * 3.0 + Vec3d(0, 1, 0)), {turn, 0.5 + latitude / kPi, 0});
    }
  expect_near(at(ball, {0, 4, 0}), {0, 1, 0});    // pole
  expect_near(at(ball, {0, 1, 0}), {0, 0.5, 0});  // centre
}

TEST(TextureMapping, MeasuresAnglesAndHeightsOnCylinders) {
  const TextureMapping tube = mapping("{'type': 'cylindrical', 'height': 2, 'repeat_u': 3, 'shift_v': 1}");
  for (const double turn : {0.05, 0.4, 0.9}) {
    const double angle = 2 * kPi * turn;
    expect_near(at(tube, {5 * std::cos(angle), 3, -5 * std::sin(angle)}), {3 * turn, 2.5, 0});
  }
}

TEST(TextureMapping, ReportsInvalidEdges) {
  EXPECT_EQ(first_problem(scene_of("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}",
                                   "{'textures': {'t': {'type': 'checker', 'mapping': {'type': 'planar', "
                                   "'u_edge': [0, 0, 0]}}}}")),
            "/textures/t/mapping/u_edge");
}

// Compares with central differences.
TEST(TextureMapping, ReturnsDerivatives) {
  Random random(1);
  constexpr double kStep = 1e-6;
  for (const char* text : {"{'type': 'planar', 'u_edge': [1, 2, 0], 'v_edge': [0, 1, 3]}",
                           "{'type': 'solid', 'size': 0.3, 'axis': [1, 2, 3]}",
                           "{'type': 'spherical', 'axis': [1, -2, 3], 'repeat_u': 4}",
                           "{'type': 'cylindrical', 'axis': [1, 2, 3], 'height': 0.5, 'repeat_v': 2}"}) {
    const MappingOf<double> mapped(mapping(text));
    for (int i = 0; i < 200; ++i) {
      const Vec3d p = random.direction() * random.between(0.5, 2), a = random.direction(),
                  b = random.direction();
      const auto c = mapped.coordinates(p, a, b);
      const auto difference = [&](const Vec3d& along) {
        const Vec3d change =
            (mapped.coordinates(p + along * kStep, a, b).at - mapped.coordinates(p - along * kStep, a, b).at);
        return change / (2 * kStep);
      };
      if (std::abs(difference(a).x) > 1000 || std::abs(difference(b).x) > 1000) continue;  // across the seam
      expect_near(c.along_first, difference(a), 1e-5 * (1 + length(c.along_first) * length(c.along_first)));
      expect_near(c.along_second, difference(b),
                  1e-5 * (1 + length(c.along_second) * length(c.along_second)));
    }
  }
}

TEST(TextureMapping, IsFiniteOnTheAxis) {
  for (const char* text : {"{'type': 'spherical'}", "{'type': 'cylindrical'}"})
    for (const Vec3d& p : {Vec3d(0), Vec3d(0, 1, 0), Vec3d(0, -1, 0), Vec3d(1e-300, 1, 0)}) {
      const auto c = MappingOf<double>(mapping(text)).coordinates(p, {1, 0, 0}, {0, 0, 1});
      for (const Vec3d& v : {c.at})
        EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
    }
}

// Projects the rim of the disc along the ray and measures the extent of its texture coordinates.
TEST(FootprintBox, EnclosesTheProjectedDisc) {
  Random random(2);
  const MappingOf<double> solid(mapping("{'type': 'solid', 'size': 0.7, 'axis': [1, 2, 3]}"));
  for (int i = 0; i < 200; ++i) {
    const Vec3d normal = random.direction(), direction = -random.direction_above(normal),
                p = random.direction();
    const double footprint = random.magnitude(1e-3, 1);
    const Tangents<double> plane = tangents_of(normal), across = tangents_of(direction);
    const auto c = solid.coordinates(p, plane.first, plane.second);
    const Vec3d box = box_of_footprint(c, plane.first, plane.second, normal, direction, footprint);
    Vec3d least(1e9), most(-1e9);
    for (int k = 0; k < 720; ++k) {
      const double angle = 2 * kPi * k / 720;
      const Vec3d e = (across.first * std::cos(angle) + across.second * std::sin(angle)) * (footprint / 2);
      const Vec3d on = p + e - direction * (dot(normal, e) / dot(normal, direction));
      const Vec3d q = solid.coordinates(on, plane.first, plane.second).at;
      least = {std::min(least.x, q.x), std::min(least.y, q.y), std::min(least.z, q.z)};
      most = largest(most, q);
    }
    expect_near(box, most - least, 1e-4 * (1 + length(box)));
  }
}

TEST(FootprintBox, IsLimitedAtGrazingRays) {
  const TextureCoordinates<float> c{{}, {1, 0, 0}, {0, 1, 0}};
  const Vec3f box = box_of_footprint<float>(c, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 0.1f);
  EXPECT_EQ(box.x, static_cast<float>(kMaxTextureWidth));
  EXPECT_GE(box.y, 0);
  EXPECT_LE(box.y, static_cast<float>(kMaxTextureWidth));
}

}  // namespace
}  // namespace orrery::test
