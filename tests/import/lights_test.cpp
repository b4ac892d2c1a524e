#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/image/encode/files.h"
#include "core/image/image.h"
#include "core/math/affine.h"
#include "tests/import/support.h"

// Compares radiance in images with the units that pbrt-v4 and Mitsuba document.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

// A matt ball of radius 1 and reflectance 0.6 about the origin. The centre of the image shows (0, 0, -1).
std::string pbrt_ball(const std::string& light) {
  return "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\nFilm \"rgb\" \"integer "
         "xresolution\" 9 "
         "\"integer yresolution\" 9\nWorldBegin\n" +
         light + "\nMaterial \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\nShape \"sphere\"\n";
}
std::string mitsuba_ball(const std::string& light) {
  return "<scene version='3.0.0'><sensor type='perspective'><transform name='to_world'><lookat "
         "origin='0,0,-5' "
         "target='0,0,0' up='0,1,0'/></transform><film type='hdrfilm'><integer name='width' "
         "value='9'/><integer "
         "name='height' value='9'/></film></sensor>" +
         light +
         "<shape type='sphere'><bsdf type='diffuse'><rgb name='reflectance' "
         "value='0.6'/></bsdf></shape></scene>";
}

Vec3f shown_at_centre(const std::string& text) {
  return centre_of(render(loaded(imported(text)), in_double()));
}

void expect_near(const Vec3f& got, const Vec3d& wanted, double relative = 1e-4) {
  EXPECT_NEAR(got.x, wanted.x, relative * wanted.x);
  EXPECT_NEAR(got.y, wanted.y, relative * wanted.y);
  EXPECT_NEAR(got.z, wanted.z, relative * wanted.z);
}

// Radiance = I cos / r^2 rho / pi: the light is 3 from the surface, above it, or at 60 degrees.
TEST(ImportedLights, PointLightFollowsUnitsOfPbrt) {
  expect_near(
      shown_at_centre(pbrt_ball("LightSource \"point\" \"rgb I\" [9 18 27] \"point3 from\" [0 0 -4]")),
      Vec3d(1, 2, 3) * (0.6 / kPi));
  expect_near(
      shown_at_centre(pbrt_ball("LightSource \"point\" \"rgb I\" [9 9 9] \"float scale\" 2 \"point3 from\" "
                                "[0 2.598076211353316 -2.5]")),
      Vec3d(2 * 0.5 * 0.6 / kPi));
  // A power of 4 pi lumens is an intensity of 1 candela.
  expect_near(
      shown_at_centre(pbrt_ball("LightSource \"point\" \"float power\" 12.566370614359172 \"point3 from\" "
                                "[0 0 -4]")),
      Vec3d(0.6 / kPi / 9));
  expect_near(shown_at_centre(pbrt_ball("Translate 0 0 -4 LightSource \"point\" \"rgb I\" [9 9 9] Identity")),
              Vec3d(0.6 / kPi));
}

TEST(ImportedLights, SpotAndDistantLightsFollowUnitsOfPbrt) {
  expect_near(shown_at_centre(
                  pbrt_ball("LightSource \"spot\" \"rgb I\" [9 9 9] \"point3 from\" [0 0 -4] \"point3 to\" "
                            "[0 0 0]")),
              Vec3d(0.6 / kPi));
  // Half way between the cones in cosine, the smooth step is 1/2.
  const double middle = std::acos((std::cos(25 * kPi / 180) + std::cos(30 * kPi / 180)) / 2);
  const std::string to = std::to_string(std::tan(middle) * 3);
  expect_near(
      shown_at_centre(pbrt_ball(
          "LightSource \"spot\" \"rgb I\" [9 9 9] \"point3 from\" [0 0 -4] \"point3 to\" [" + to + " 0 -1]")),
      Vec3d(0.6 / kPi / 2), 1e-3);
  expect_near(
      shown_at_centre(pbrt_ball("LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 0 -1]")),
      Vec3d(2 * 0.6 / kPi));
  expect_near(
      shown_at_centre(pbrt_ball("LightSource \"distant\" \"rgb L\" [1 1 1] \"float illuminance\" 5 \"point3 "
                                "from\" [0 0 -1]")),
      Vec3d(5 * 0.6 / kPi));
}

TEST(ImportedLights, EmittersFollowUnitsOfMitsuba) {
  expect_near(shown_at_centre(
                  mitsuba_ball("<emitter type='point'><point name='position' z='-4'/><rgb name='intensity' "
                               "value='9 18 27'/></emitter>")),
              Vec3d(1, 2, 3) * (0.6 / kPi));
  expect_near(
      shown_at_centre(mitsuba_ball("<emitter type='spot'><transform name='to_world'><translate z='-4'/>"
                                   "</transform><rgb name='intensity' value='9'/></emitter>")),
      Vec3d(0.6 / kPi));
  expect_near(shown_at_centre(mitsuba_ball("<emitter type='directional'><vector name='direction' z='1'/><rgb "
                                           "name='irradiance' value='2'/></emitter>")),
              Vec3d(2 * 0.6 / kPi));
}

TEST(ImportedLights, ConstantSurroundingsHaveTheirRadiance) {
  const std::string far = "Translate 50 50 0 ";
  const auto corner = [](const std::string& text) { return render(loaded(imported(text))).at(0, 0); };
  expect_near(corner(pbrt_ball("LightSource \"infinite\" \"rgb L\" [0.5 0.25 2]" + far)), {0.5, 0.25, 2});
  expect_near(corner(pbrt_ball("LightSource \"infinite\" \"float illuminance\" 6.283185307179586")),
              Vec3d(2));
  expect_near(corner(pbrt_ball(
                  "LightSource \"infinite\" \"rgb L\" [1 1 1] LightSource \"infinite\" \"rgb L\" [1 2 3]")),
              {2, 3, 4});
  expect_near(
      corner(mitsuba_ball("<emitter type='constant'><rgb name='radiance' value='0.5 0.25 2'/></emitter>")),
      {0.5, 0.25, 2});
}

// A black body has luminance "scale". Power P on two sides of area A is radiance P / (2 pi A).
TEST(ImportedLights, AreaLightsHaveTheirRadiance) {
  const auto emission = [](const std::string& light, const std::string& shape) {
    const auto scene = imported("WorldBegin AreaLightSource \"diffuse\" " + light + " Shape " + shape).scene;
    return scene.at("materials").at("diffuse").at("emission").get<std::vector<double>>();
  };
  const auto black_body = emission("\"blackbody L\" 3000 \"float scale\" 7", "\"sphere\"");
  EXPECT_NEAR(0.2126 * black_body[0] + 0.7152 * black_body[1] + 0.0722 * black_body[2], 7, 1e-9);
  EXPECT_GT(black_body[0], 2 * black_body[2]);
  EXPECT_EQ(emission("\"rgb L\" [1 2 3]", "\"sphere\""), (std::vector<double>{1, 2, 3}));
  EXPECT_NEAR(emission("\"float power\" 100", "\"sphere\" \"float radius\" 2")[0], 100 / (kPi * 4 * kPi * 4),
              1e-12);
  EXPECT_NEAR(emission("\"float power\" 100 \"bool twosided\" true", "\"disk\" \"float radius\" 2")[0],
              100 / (2 * kPi * kPi * 4), 1e-12);
  EXPECT_NEAR(emission("\"float power\" 100", "\"trianglemesh\" \"point3 P\" [0 0 0 2 0 0 0 3 0]")[0],
              100 / (3 * kPi), 1e-12);
}

TEST(ImportedLights, ExposureMultipliesLight) {
  const auto scene = imported(
                         "Camera \"perspective\" \"float shutterclose\" 0.5\nFilm \"rgb\" \"float iso\" 400\n"
                         "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] Shape \"sphere\"")
                         .scene;
  EXPECT_EQ(scene.at("environment").at("radiance")[0].get<double>(), 2);
}

// Direction of a point of an equal-area octahedral image: Clarberg 2008, with the axes of pbrt-v4.
Vec3d octahedral_direction(double s, double t) {
  const double u = 2 * s - 1, v = 2 * t - 1, distance = 1 - (std::abs(u) + std::abs(v));
  const double r = 1 - std::abs(distance);
  const double phi = (r == 0 ? 1 : (std::abs(v) - std::abs(u)) / r + 1) * kPi / 4;
  const double flat = r * std::sqrt(2 - r * r);
  return {std::copysign(std::cos(phi), u) * flat, std::copysign(std::sin(phi), v) * flat,
          std::copysign(1 - r * r, distance)};
}

Vec3d colour_toward(const Vec3d& d) { return (d + Vec3d(1)) * 0.5 + Vec3d(0.25); }

template <class Color>
std::string exr_of(int width, int height, const Color& color) {
  Image image(width, height, PixelFormat::linear32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3f pixel(color((x + 0.5) / width, (y + 0.5) / height));
      std::memcpy(&image.bytes()[static_cast<std::size_t>(12 * (y * width + x))], &pixel, 12);
    }
  return encode_exr(image);
}

// Every direction of the scene shows the colour of the direction in the axes of the light.
TEST(ImportedLights, OctahedralSurroundingsKeepDirections) {
  const Files files{{"sky.exr", exr_of(128, 128, [](double s, double t) {
                       return colour_toward(octahedral_direction(s, t));
                     })}};
  const std::string text =
      "Camera \"perspective\" WorldBegin AttributeBegin Rotate 40 1 2 3 LightSource \"infinite\" "
      "\"string filename\" \"sky.exr\" \"float scale\" 2 AttributeEnd Translate 0 -90 0 Shape \"sphere\"";
  const ImportedScene from = imported(text, files);
  ASSERT_EQ(from.files.size(), 1u);
  const Affined turn = rotation(normalize(Vec3d(1, 2, 3)), 40);
  Json scene = from.scene;
  scene["render"] = {{"technique", "raycast"}};
  for (const Vec3d& toward : {Vec3d(1, 0, 0), Vec3d(0, 1, 0.2), Vec3d(0, 0, -1), Vec3d(-0.3, -0.5, 0.8)}) {
    scene["camera"] = {{"type", "perspective"},
                       {"eye", {0, 0, 0}},
                       {"look_at", numbers(toward)},
                       {"up", {0.1, 0.2, 1}},
                       {"fov_degrees", 1}};
    const auto picture = render(load_with(scene, {{from.files[0].name, from.files[0].bytes}}), size(3, 3));
    // The pbrt scene is left-handed: z of the converted scene is -z of pbrt.
    const Vec3d in_pbrt(toward.x, toward.y, -toward.z);
    const Vec3d wanted = colour_toward(inverse(turn).vector(normalize(in_pbrt))) * 2;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(centre_of(picture)[i], wanted[i], 0.03);
  }
}

// Mitsuba: the left edge of the image looks along -z, and a quarter to the right of it is +x.
TEST(ImportedLights, EquirectangularSurroundingsKeepDirections) {
  const auto color = [](double s, double t) {
    const double azimuth = s * 2 * kPi;
    return colour_toward(
        {std::sin(azimuth) * std::sin(t * kPi), std::cos(t * kPi), -std::cos(azimuth) * std::sin(t * kPi)});
  };
  const Files files{{"sky.exr", exr_of(256, 128, color)}};
  for (const char* const turn : {"", "<rotate y='1' angle='30'/>", "<rotate x='1' angle='50'/>"}) {
    const ImportedScene from = imported(
        mitsuba_ball(
            "<emitter type='envmap'><string name='filename' value='sky.exr'/><transform name='to_world'>" +
            std::string(turn) + "</transform></emitter>"),
        files);
    EXPECT_EQ(from.files.size(), std::string(turn).find("x=") == std::string::npos ? 0u : 1u);
    const Affined map =
        turn[0] == 0 ? Affined()
                     : rotation(turn[8] == 'y' ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0), turn[8] == 'y' ? 30 : 50);
    Json scene = from.scene;
    scene["render"] = {{"technique", "raycast"}};
    scene["objects"][0]["center"] = {0, 0, 99};
    Files all = files;
    for (const ImportedFile& file : from.files) all[file.name] = file.bytes;
    const Vec3d toward = normalize(Vec3d(0.8, 0.3, -0.5));
    scene["camera"] = {
        {"type", "perspective"}, {"eye", {0, 0, 0}}, {"look_at", numbers(toward)}, {"fov_degrees", 1}};
    const auto picture = render(load_with(scene, all), size(3, 3));
    const Vec3d wanted = colour_toward(inverse(map).vector(toward));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(centre_of(picture)[i], wanted[i], 0.03) << turn;
  }
}

}  // namespace
}  // namespace orrery::test
