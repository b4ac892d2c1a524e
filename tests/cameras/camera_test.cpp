#include "core/model/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/base/error.h"
#include "core/load/load.h"
#include "core/plan/plan.h"
#include "tests/support/batches.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace orrery::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

struct PlacedCamera {
  CameraPlacement placement;
  std::shared_ptr<const Camera> camera;
};

std::shared_ptr<const Camera> camera_of(Json own) {
  own["eye"] = {0, 0, 4};
  own["look_at"] = {0, 0, 0};
  return load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"), {{"camera", own}}))
      ->camera;
}

PlacedCamera looking_at_origin(const Vec3d& eye = {0, 0, 4}) {
  static const std::shared_ptr<const Camera> perspective = camera_of({{"type", "perspective"}});
  return {{.eye = eye}, perspective};
}

CameraFrame frame_at(const PlacedCamera& standing, const Orbit& orbit) {
  return orrery::frame_at(standing.placement, *standing.camera, orbit);
}

// Returns the ray through the centre of pixel (x, y).
Ray<double> ray_through(const PlacedCamera& standing, int width, int height, int x, int y) {
  const auto rays = std::make_unique<RayBatch<double>>();
  const int x0 = x / kTileSide * kTileSide, y0 = y / kTileSide * kTileSide;
  standing.camera->generate(frame_at(standing, {}), width, height, {x0, y0, kTileSide, kTileSide},
                            TileSamples::centres(), *rays);
  for (int slot = 0; slot < kBatch; ++slot)
    if (x0 + tile_pixel(slot).x == x && y0 + tile_pixel(slot).y == y)
      return {rays->origin[slot], rays->direction[slot]};
  return {};
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Orbit, MatchesRotationFormula) {
  for (const double dt : {0.0, 10.0, 45.0, 90.0, 123.0, -60.0, 270.0}) {
    const PlacedCamera camera = looking_at_origin({1, 2, 3});
    const double c = std::cos(dt * kRadians), s = std::sin(dt * kRadians);
    expect_near(frame_at(camera, {dt, 0, 1}).eye, Vec3d(1 * c + 3 * s, 2, -1 * s + 3 * c), 1e-14);
  }
}

TEST(Orbit, PreservesSceneCameraExactly) {
  const PlacedCamera camera = looking_at_origin({0.1, 0.7, 3.3});
  EXPECT_EQ(frame_at(camera, {}).eye, camera.placement.eye);
  EXPECT_EQ(frame_at(camera, {360, 0, 1}).eye, camera.placement.eye);
}

TEST(Orbit, PansEyeAndTargetTogether) {
  const PlacedCamera camera = looking_at_origin({0.1, 0.7, 3.3});
  const Vec3d pan{0.5, -2, 8};
  PlacedCamera moved = camera;
  moved.placement.eye = moved.placement.eye + pan;
  moved.placement.look_at = moved.placement.look_at + pan;
  const CameraFrame own = frame_at(camera, {.pan = pan}), there = frame_at(moved, {});
  EXPECT_EQ(own.eye, there.eye);
  expect_near(own.back, there.back, 1e-15);
  const CameraFrame turned = frame_at(camera, {40, 10, 2, pan}), unmoved = frame_at(camera, {40, 10, 2});
  EXPECT_EQ(turned.eye, unmoved.eye + pan);
  EXPECT_EQ(turned.back, unmoved.back);
}

TEST(Orbit, ReturnsToStartAfterFullTurns) {
  covers("E10");
  const PlacedCamera camera = looking_at_origin({1, 2, 3});
  for (const double azimuth : {0.0, 33.5, -17.25, 180.0})
    for (const double turns : {1.0, 100.0, 2777.0}) {  // up to a million degrees
      const CameraFrame a = frame_at(camera, {azimuth, 10, 1}),
                        b = frame_at(camera, {azimuth + 360 * turns, 10, 1});
      EXPECT_EQ(a.eye, b.eye) << azimuth << " and " << turns << " turns";
      EXPECT_EQ(a.right, b.right);
    }
}

TEST(Orbit, KeepsOrientationAtPoles) {
  covers("E8");
  for (const double azimuth : {0.0, 30.0, 90.0, 200.0}) {
    const CameraFrame top = frame_at(looking_at_origin(), {azimuth, 90, 1});
    expect_near(top.back, Vec3d(0, 1, 0), 1e-15);
    expect_near(top.right, Vec3d(std::cos(azimuth * kRadians), 0, -std::sin(azimuth * kRadians)), 1e-15);
    expect_near(top.eye, Vec3d(0, 4, 0), 1e-14);
    const CameraFrame bottom = frame_at(looking_at_origin(), {azimuth, -90, 1});
    expect_near(bottom.back, Vec3d(0, -1, 0), 1e-15);
    expect_near(bottom.right, top.right, 1e-15);
    const CameraFrame near = frame_at(looking_at_origin(), {azimuth, 90 - 1e-9, 1});
    expect_near(near.up, top.up, 1e-10);
    expect_near(near.eye, top.eye, 1e-9);
  }
}

TEST(Orbit, ClampsElevationAtPoles) {
  const PlacedCamera camera = looking_at_origin({0, 3, 4});  // 36.87 degrees above the equator
  expect_near(frame_at(camera, {0, 60, 1}).back, Vec3d(0, 1, 0), 1e-15);
  expect_near(frame_at(camera, {0, 180, 1}).back, Vec3d(0, 1, 0), 1e-15);
  expect_near(frame_at(camera, {0, -180, 1}).back, Vec3d(0, -1, 0), 1e-15);
  expect_near(frame_at(camera, {0, -36.86989764584402, 1}).eye, Vec3d(0, 0, 5), 1e-14);
}

TEST(Orbit, ReturnsOrthonormalUprightFrame) {
  covers("E8");
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    PlacedCamera camera = looking_at_origin();
    camera.placement.eye = random.in_cube(10);
    camera.placement.look_at = random.in_cube(10);
    camera.placement.up = random.direction() * random.magnitude(1e-3, 1e3);
    const CameraFrame f =
        frame_at(camera, {random.between(-1e6, 1e6), random.between(-180, 180), random.magnitude(1e-3, 1e3)});
    for (const Vec3d& v : {f.right, f.up, f.back}) EXPECT_NEAR(length(v), 1, 1e-14);
    EXPECT_NEAR(dot(f.right, f.up), 0, 1e-14);
    EXPECT_NEAR(dot(f.up, f.back), 0, 1e-14);
    EXPECT_NEAR(dot(cross(f.right, f.up), f.back), 1, 1e-14) << "right-handed";
    EXPECT_GE(dot(f.up, safe_normalize(camera.placement.up)), -1e-14) << "never upside down";
  }
}

TEST(CameraRays, FollowsAxisInSinglePixelImage) {
  covers("E11");
  expect_near(ray_through(looking_at_origin(), 1, 1, 0, 0).direction, Vec3d(0, 0, -1), 1e-15);
  const PlacedCamera slanted = looking_at_origin({1, 2, 3});
  expect_near(ray_through(slanted, 1, 1, 0, 0).direction, safe_normalize(Vec3d(-1, -2, -3)), 1e-15);
}

// The image height determines the scale of both axes, whatever the aspect ratio.
TEST(CameraRays, ScalesBothAxesByHeight) {
  covers("E9");
  const PlacedCamera camera = looking_at_origin();
  const auto slope = [&](int width, int height, int x, int y) {
    const Vec3d d = ray_through(camera, width, height, x, y).direction;
    return Vec3d(d.x / -d.z, d.y / -d.z, 0);
  };
  const double top = std::tan(22.5 * kRadians);
  const Vec3d corner = slope(640, 360, 0, 0);
  EXPECT_NEAR(corner.y, top * (1 - 1 / 360.0), 1e-14);
  EXPECT_NEAR(corner.x, -top * 640 / 360 * (1 - 1 / 640.0), 1e-14);
  EXPECT_NEAR(slope(360, 640, 359, 639).y, -top * (1 - 1 / 640.0), 1e-14);
  EXPECT_NEAR(slope(360, 640, 359, 639).x, top * 360 / 640 * (1 - 1 / 360.0), 1e-14);
}

TEST(CameraRays, MirrorsExactlyAboutCentre) {
  const PlacedCamera camera = looking_at_origin();
  for (const int width : {5, 64, 99})
    for (int x = 0; x < width; x += 3) {
      const Vec3d left = ray_through(camera, width, 40, x, 7).direction,
                  right = ray_through(camera, width, 40, width - 1 - x, 7).direction;
      EXPECT_EQ(left, Vec3d(-right.x, right.y, right.z)) << x << " of " << width;
    }
}

TEST(CameraRays, SpacesParallelOrthographicRaysByHeight) {
  const PlacedCamera camera{{}, camera_of({{"type", "orthographic"}, {"height", 3}})};
  const Ray<double> first = ray_through(camera, 200, 100, 0, 0),
                    last = ray_through(camera, 200, 100, 199, 99);
  EXPECT_EQ(first.direction, Vec3d(0, 0, -1));
  expect_near(first.origin, Vec3d(-3 + 0.015, 1.5 - 0.015, 4), 1e-14);
  expect_near(last.origin, Vec3d(3 - 0.015, -1.5 + 0.015, 4), 1e-14);
  EXPECT_NEAR(frame_at(camera, {0, 0, 2}).half_extent, 3, 1e-15)
      << "the visible extent grows with the distance";
}

// Longitude increases linearly to the right and latitude linearly upward. The centre is the view direction.
TEST(CameraRays, SpacesPanoramaAnglesEvenly) {
  const PlacedCamera camera{{}, camera_of({{"type", "panorama"}})};
  const int width = 128, height = 64;
  for (int y = 0; y < height; y += 7)
    for (int x = 0; x < width; x += 5) {
      const double longitude = 2 * std::numbers::pi * ((x + 0.5) / width - 0.5),
                   latitude = std::numbers::pi * (0.5 - (y + 0.5) / height);
      const Ray<double> ray = ray_through(camera, width, height, x, y);
      expect_near(ray.direction,
                  {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                   -std::cos(latitude) * std::cos(longitude)},
                  1e-14);
      EXPECT_EQ(ray.origin, Vec3d(0, 0, 4));
    }
}

TEST(CameraRays, DeactivatesPixelsOutsideImage) {
  const auto rays = std::make_unique<RayBatch<float>>();
  const PlacedCamera standing = looking_at_origin();
  standing.camera->generate(frame_at(standing, {}), 37, 35, TileGrid(37, 35).at(3, 1), TileSamples::centres(),
                            *rays);
  EXPECT_EQ(active_rays(*rays, groups_of(*rays)), 5u * 3u);
}

TEST(Camera, RejectsInvalidSceneCameras) {
  covers("E10");
  const auto problem = [](const char* camera) {
    return first_problem(scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]",
                                  std::string("{'camera': ") + camera + "}"));
  };
  EXPECT_EQ(problem("{'fov_degrees': 0}"), "/camera/fov_degrees");
  EXPECT_EQ(problem("{'type': 'panorama', 'eye': [0, 0, 4], 'look_at': [0, 0, 0], 'aperture_radius': 0.1}"),
            "/camera/aperture_radius");
  EXPECT_EQ(problem("{'type': 'panorama', 'eye': [0, 0, 4], 'look_at': [0, 0, 0], 'aperture_radius': 0}"),
            "accepted");
  for (const char* blades : {"1", "2", "17", "-3"})
    EXPECT_EQ(problem(("{'aperture_blades': " + std::string(blades) + "}").c_str()),
              "/camera/aperture_blades")
        << blades;
  EXPECT_EQ(problem("{'fov_degrees': 180}"), "/camera/fov_degrees");
  EXPECT_EQ(problem("{'eye': [1, 2, 3], 'look_at': [1, 2, 3]}"), "/camera/look_at");
  EXPECT_EQ(problem("{'eye': [0, 5, 0]}"), "accepted");  // the camera takes another up
  EXPECT_EQ(problem("{'up': [0, 0, 0]}"), "/camera/up");
  EXPECT_EQ(problem("{'fov_degrees': 179.9}"), "accepted");
}

TEST(Camera, RejectsInvalidRequests) {
  covers("E10");
  const auto problem = [](const char* camera) -> std::string {
    try {
      read_request(parse_document(Json{{"camera", json(camera)}}.dump()));
    } catch (const InputError& error) {
      return error.problems().front().pointer;
    }
    return "accepted";
  };
  EXPECT_EQ(problem("{'fov_degrees': 0}"), "/camera/fov_degrees");
  EXPECT_EQ(problem("{'fov_degrees': 180}"), "/camera/fov_degrees");
  EXPECT_EQ(problem("{'distance': 0}"), "/camera/distance");
  EXPECT_EQ(problem("{'elevation_degrees': 181}"), "/camera/elevation_degrees");
  EXPECT_EQ(problem("{'azimuth_degrees': 1e6}"), "accepted");
  EXPECT_EQ(problem("{'azimuth_degrees': 1e300}"), "/camera/azimuth_degrees");
}

}  // namespace
}  // namespace orrery::test
