#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/affine.h"
#include "tests/import/support.h"

// Renders a small lamp and compares its pixel with the projection of the other renderer.
namespace orrery::test {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

std::string text_of_point(const Vec3d& p) {
  return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
}

struct PbrtCase {
  const char* name;
  std::string transform;                           // before the camera
  Vec3d (*camera_from_world)(const Vec3d& world);  // the same map by the formulas of the book
  int width, height;
};

// Camera coordinates by LookAt: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th ed., section 3.9.1:
// right = up x direction, new up = direction x right.
Vec3d looked_at(const Vec3d& p, const Vec3d& eye, const Vec3d& target) {
  const Vec3d direction = normalize(target - eye), right = normalize(cross(Vec3d(0, 1, 0), direction));
  const Vec3d from = p - eye;
  return {dot(from, right), dot(from, cross(direction, right)), dot(from, direction)};
}

const PbrtCase kPbrtCases[] = {{"identity", "", [](const Vec3d& p) { return p; }, 60, 40},
                               {"look at", "LookAt 2 3 -6  0 1 0  0 1 0",
                                [](const Vec3d& p) {
                                  return looked_at(p, {2, 3, -6}, {0, 1, 0});
                                },
                                60, 40},
                               {"portrait", "LookAt 2 3 -6  0 1 0  0 1 0",
                                [](const Vec3d& p) {
                                  return looked_at(p, {2, 3, -6}, {0, 1, 0});
                                },
                                40, 60},
                               {"right-handed", "Scale -1 1 1 LookAt 2 3 6  0 1 0  0 1 0",
                                [](const Vec3d& p) {
                                  const Vec3d c = looked_at(p, {2, 3, 6}, {0, 1, 0});
                                  return Vec3d(-c.x, c.y, c.z);
                                },
                                60, 40},
                               {"rotated", "Translate 0.5 -0.25 4 Rotate 30 0 0 1",
                                [](const Vec3d& p) {
                                  return rotation({0, 0, 1}, 30).vector(p) + Vec3d(0.5, -0.25, 4);
                                },
                                60, 40}};

TEST(ImportedView, ShowsPointsWherePbrtDoes) {
  for (const PbrtCase& one : kPbrtCases)
    for (const Vec3d& at : {Vec3d(0.8, 0.6, 1.5), Vec3d(-0.7, 0.7, 2), Vec3d(0.3, 0.4, 1)}) {
      const std::string text =
          one.transform + "\nCamera \"perspective\" \"float fov\" 50\nFilm \"rgb\" \"integer xresolution\" " +
          std::to_string(one.width) + " \"integer yresolution\" " + std::to_string(one.height) +
          "\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nTranslate " + text_of_point(at) +
          "\nShape \"sphere\" \"float radius\" 0.03\n";
      const Vec3d camera = one.camera_from_world(at);
      const double half = std::min(one.width, one.height) / 2.0;  // pixels from the centre at x / z = tan 25
      const double x = one.width / 2.0 + half * camera.x / camera.z / std::tan(25 * kDegrees);
      const double y = one.height / 2.0 - half * camera.y / camera.z / std::tan(25 * kDegrees);
      const Picture picture = render(loaded(imported(text)), size(one.width * 4, one.height * 4));
      const Spot2 spot = bright_spot(picture);
      ASSERT_GT(spot.pixels, 0) << one.name;
      EXPECT_NEAR(spot.x / 4, x, 0.2) << one.name;
      EXPECT_NEAR(spot.y / 4, y, 0.2) << one.name;
    }
}

// Mitsuba: right-handed, the camera looks along +z with +x to the left; fov is that of the x axis by default.
TEST(ImportedView, ShowsPointsWhereMitsubaDoes) {
  struct {
    const char* axis;
    double half_width;  // half the width of a view of 60 x 40 at distance 1
  } constexpr kAxes[] = {
      {"x", 1}, {"y", 1.5}, {"smaller", 1.5}, {"larger", 1}, {"diagonal", 0.83205029433784}};
  const Vec3d eye{2, 3, 6}, target{0, 1, 0}, at{0.8, 0.6, 1.5};
  for (const bool mirrored : {false, true})
    for (const auto& [axis, half_width] : kAxes) {
      const std::string scale = mirrored ? "<scale x='-1'/>" : "";
      const std::string text =
          "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='50'/><string "
          "name='fov_axis' "
          "value='" +
          std::string(axis) + "'/><transform name='to_world'>" + scale +
          "<lookat origin='2,3,6' target='0,1,0' up='0,1,0'/></transform><film type='hdrfilm'><integer "
          "name='width' "
          "value='60'/><integer name='height' value='40'/></film></sensor><shape type='sphere'><float "
          "name='radius' "
          "value='0.03'/><point name='center' x='0.8' y='0.6' z='1.5'/><emitter type='area'><rgb "
          "name='radiance' "
          "value='1'/></emitter></shape></scene>";
      const Vec3d forward = normalize(target - eye), right = normalize(cross(forward, Vec3d(0, 1, 0)));
      const Vec3d up = cross(right, forward), from = at - eye;
      const double per_unit = 30 / (half_width * std::tan(25 * kDegrees)) / dot(from, forward);
      const double x = 30 + (mirrored ? -1 : 1) * per_unit * dot(from, right),
                   y = 20 - per_unit * dot(from, up);
      const Spot2 spot = bright_spot(render(loaded(imported(text)), size(240, 160)));
      ASSERT_GT(spot.pixels, 0) << axis;
      EXPECT_NEAR(spot.x / 4, x, 0.2) << axis << mirrored;
      EXPECT_NEAR(spot.y / 4, y, 0.2) << axis << mirrored;
    }
}

TEST(ImportedView, KeepsLensScreenWindowAndSize) {
  const auto scene =
      imported(
          "Scale 2 2 2\nCamera \"perspective\" \"float fov\" 60 \"float lensradius\" 0.1 \"float "
          "focaldistance\" 5 "
          "\"float screenwindow\" [-0.5 0.5 -0.25 0.25]\nFilm \"rgb\" \"integer xresolution\" 5000 \"integer "
          "yresolution\" 2500\nWorldBegin\nShape \"sphere\"")
          .scene;
  const auto& camera = scene.at("camera");
  EXPECT_DOUBLE_EQ(camera.at("aperture_radius").get<double>(), 0.05);  // camera space is twice as large
  EXPECT_DOUBLE_EQ(camera.at("focus_distance").get<double>(), 2.5);
  EXPECT_NEAR(camera.at("fov_degrees").get<double>(),
              2 * std::atan(0.25 * std::tan(30 * kDegrees)) / kDegrees, 1e-9);
  EXPECT_EQ(scene.at("image").at("width"), 4096);
  EXPECT_EQ(scene.at("image").at("height"), 2048);
}

TEST(ImportedView, KeepsHeightOfOrthographicViews) {
  const auto pbrt = imported(
      "Scale 0.5 0.5 0.5 Camera \"orthographic\" \"float screenwindow\" [-3 3 -2 2]\nFilm \"rgb\" "
      "\"integer xresolution\" 60 \"integer yresolution\" 40\nWorldBegin\nShape \"sphere\"");
  EXPECT_DOUBLE_EQ(pbrt.scene.at("camera").at("height").get<double>(), 8);  // 4 in camera space
  const auto mitsuba = imported(
      "<scene version='3.0.0'><sensor type='orthographic'><transform name='to_world'><scale x='3' "
      "y='3'/></transform>"
      "<film type='hdrfilm'><integer name='width' value='60'/><integer name='height' "
      "value='40'/></film></sensor>"
      "<shape type='sphere'/></scene>");
  EXPECT_DOUBLE_EQ(mitsuba.scene.at("camera").at("height").get<double>(), 4);  // 6 wide
}

}  // namespace
}  // namespace orrery::test
