#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/load/load.h"
#include "tests/support/pictures.h"
#include "tests/support/scenes.h"

// Parameters that every material has: emission, opacity, normal map. And vertex colours of meshes.
namespace orrery::test {
namespace {

// Serves one image.
class Painted final : public AssetSource {
 public:
  explicit Painted(Texels texels) : texels_(std::make_shared<const Texels>(std::move(texels))) {}
  TexelsPtr picture_file(const std::string&) const override { return texels_; }

 private:
  TexelsPtr texels_;
};

// Returns an image with the colour c everywhere.
Texels painted(const Vec3f& c, std::vector<float> alpha = {}) {
  Texels texels{2, 2, {}, std::move(alpha)};
  for (int i = 0; i < 4; ++i) texels.rgb.insert(texels.rgb.end(), {c.x, c.y, c.z});
  return texels;
}

// A square of side 2 in the plane z = 0 that faces the camera and fills the image. u grows to the right, v
// upward.
Json square(const Json& material, const Json& textures) {
  Json scene = json(R"({
    'version': 1, 'background': [0, 0, 1],
    'camera': {'type': 'orthographic', 'eye': [0, 0, 3], 'look_at': [0, 0, 0], 'height': 2},
    'lights': [{'type': 'directional', 'direction_to_light': [0, 0, 1], 'intensity': [1, 1, 1]}],
    'objects': [{'type': 'mesh', 'material': 'm', 'indices': [[0, 1, 2], [0, 2, 3]],
      'positions': [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], 'uvs': [[0, 0], [1, 0], [1, 1], [0, 1]]}]
  })");
  scene["materials"]["m"] = material;
  scene["textures"] = textures;
  return scene;
}

Picture rendered(const Json& scene, const AssetSource& assets, int side = 32,
                 const char* technique = "raycast", int samples = 1) {
  RenderRequest request = in_double(size(side, side));
  request.technique = technique;
  request.samples = samples;
  return render(load_scene(scene.dump(), assets), request);
}

const Json kImage = {{"t", {{"type", "image"}, {"file", "f"}, {"encoding", "linear"}}}};

Json mapped(double scale = 1) {
  return {{"type", "lambert"}, {"reflectance", 1}, {"normal_map", {{"texture", "t"}, {"scale", scale}}}};
}

// A normal map of one colour turns the normal of a flat square to (2 c - 1). The light comes along (1, 2, 2)
// / 3.
TEST(NormalMaps, TurnNormalsOfFlatSurfaces) {
  const Vec3d light = safe_normalize(Vec3d(1, 2, 2));
  for (const Vec3d& normal :
       {Vec3d(0, 0, 1), Vec3d(0.6, 0, 0.8), Vec3d(0, -0.6, 0.8), Vec3d(-0.36, 0.48, 0.8)})
    for (const double scale : {1.0, 0.5}) {
      const Painted assets(painted(Vec3f((normal + Vec3d(1)) / 2)));
      Json scene = square(mapped(scale), kImage);
      scene["lights"][0]["direction_to_light"] = numbers(light);
      const Vec3d turned = safe_normalize(Vec3d(normal.x * scale, normal.y * scale, normal.z));
      const Picture seen = rendered(scene, assets);
      EXPECT_NEAR(double{seen.at(11, 17).x}, std::max(0.0, dot(turned, light)), 1e-6);
    }
}

// Texture coordinates that are mirrored, or turned by a quarter, mirror and turn the normal.
TEST(NormalMaps, FollowTextureCoordinates) {
  const Painted assets(painted(Vec3f(0.8f, 0.5f, 0.9f)));  // the normal (0.6, 0, 0.8)
  const auto lit = [&](const char* uvs, const Vec3d& light) {
    Json scene = square(mapped(), kImage);
    scene["objects"][0]["uvs"] = json(uvs);
    scene["lights"][0]["direction_to_light"] = numbers(light);
    return double{rendered(scene, assets).at(11, 17).x};
  };
  EXPECT_NEAR(lit("[[0, 0], [1, 0], [1, 1], [0, 1]]", {0.6, 0, 0.8}), 1, 1e-6);
  EXPECT_NEAR(lit("[[1, 0], [0, 0], [0, 1], [1, 1]]", {-0.6, 0, 0.8}), 1, 1e-6);
  EXPECT_NEAR(lit("[[0, 0], [0, 1], [-1, 1], [-1, 0]]", {0, -0.6, 0.8}), 1, 1e-6);
}

// From behind, the normal points to the viewer and keeps its plane.
TEST(NormalMaps, TurnBacksOfSurfacesToViewer) {
  const Painted assets(painted(Vec3f(0.8f, 0.5f, 0.9f)));
  Json scene = square(mapped(), kImage);
  scene["camera"]["eye"] = numbers(Vec3d(0, 0, -3));
  scene["lights"][0]["direction_to_light"] = numbers(Vec3d(-0.6, 0, -0.8));
  EXPECT_NEAR(double{rendered(scene, assets).at(11, 17).x}, 1, 1e-6);
}

TEST(Emission, ShowsTheColoursOfTexture) {
  const Vec3f color(0.5f, 0.25f, 0.125f);
  const Painted assets(painted(color));
  const Json material = {
      {"type", "lambert"}, {"reflectance", 0}, {"emission", {{"texture", "t"}, {"tint", {1, 2, 4}}}}};
  for (const char* technique : {"raycast", "whitted", "distributed", "path"}) {
    const Picture seen = rendered(square(material, kImage), assets, 16, technique);
    for (const int x : {2, 9}) {
      EXPECT_NEAR(double{seen.at(x, 5).x}, 0.5, 1e-6) << technique;
      EXPECT_NEAR(double{seen.at(x, 5).y}, 0.5, 1e-6) << technique;
      EXPECT_NEAR(double{seen.at(x, 5).z}, 0.5, 1e-6) << technique;
    }
  }
}

// In a closed room whose walls emit E and reflect half of the light, one reflection adds E / 2.
TEST(Emission, OfTexturesLightsOtherSurfaces) {
  const Painted assets(painted(Vec3f(0.5f, 0.5f, 0.5f)));
  Json scene = json(R"({
    'version': 1, 'camera': {'type': 'perspective', 'eye': [0, 0, 0.5], 'look_at': [0, 0, 0]},
    'objects': [{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 1], 'material': 'm'}],
    'textures': {'t': {'type': 'image', 'file': 'f', 'encoding': 'linear'}},
    'materials': {'m': {'type': 'lambert', 'reflectance': 0.5, 'emission': {'texture': 't'}}},
    'render': {'max_depth': 1}})");
  const Picture seen = rendered(scene, assets, 8, "path", 4);
  EXPECT_NEAR(double{seen.at(3, 3).x}, 0.75, 1e-6);
}

TEST(VertexColors, MultiplyTexturesAndAreInterpolated) {
  const Painted assets(painted(Vec3f(1, 0.5f, 0.25f)));
  Json textures = kImage;
  textures["t"]["vertex_colors"] = true;
  Json scene = square({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}}, textures);
  scene["objects"][0]["colors"] = json("[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]");
  const Picture seen = rendered(scene, assets);  // red = x / 32, green = y / 32 from below
  for (const auto& [x, y] : {std::pair(4, 9), std::pair(30, 2), std::pair(16, 31)}) {
    EXPECT_NEAR(double{seen.at(x, y).x}, (x + 0.5) / 32, 1e-6);
    EXPECT_NEAR(double{seen.at(x, y).y}, 0.5 * (1 - (y + 0.5) / 32), 1e-6);
    EXPECT_EQ(seen.at(x, y).z, 0);
  }
}

TEST(VertexColors, AreWhiteOfMeshesWithoutColors) {
  const Json textures = {{"t", {{"type", "uniform"}, {"color", {0.5, 0.25, 1}}, {"vertex_colors", true}}}};
  const Picture seen =
      rendered(square({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}}, textures), AssetSource());
  EXPECT_NEAR(double{seen.at(5, 5).x}, 0.5, 1e-6);
  EXPECT_NEAR(double{seen.at(5, 5).z}, 1, 1e-6);
}

TEST(VertexColors, MustBeFromZeroToOne) {
  Json scene = square({{"type", "lambert"}}, Json::object());
  scene["objects"][0]["colors"] = json("[[0, 0, 0], [1, 0, 0], [1, 1.5, 0], [0, 1, 0]]");
  EXPECT_THROW(load_scene(scene.dump()), InputError);
}

// Behind the square, a second one emits red.
Json two_squares(const Json& material, const Json& textures) {
  Json scene = square(material, textures);
  Json behind = scene["objects"][0];
  for (Json& p : behind["positions"]) p[2] = -1;
  behind["material"] = "red";
  scene["materials"]["red"] = json("{'type': 'lambert', 'reflectance': 0, 'emission': [1, 0, 0]}");
  scene["objects"].push_back(behind);
  return scene;
}

// An alpha that rises linearly from 1/4 to 3/4 between the centres of the texels cuts where it equals the
// cutoff.
TEST(Opacity, CutsAtTheCutoff) {
  const Painted assets(painted(Vec3f(1, 1, 1), {0.25f, 0.75f, 0.25f, 0.75f}));
  const Json textures = {{"t", {{"type", "image"}, {"file", "f"}, {"encoding", "alpha"}, {"wrap", "clamp"}}}};
  for (const double cutoff : {0.4, 0.5, 0.7}) {
    const Json material = {{"type", "lambert"},
                           {"reflectance", 0},
                           {"emission", {0, 1, 0}},
                           {"opacity", {{"texture", "t"}}},
                           {"alpha_cutoff", cutoff}};
    for (const char* technique : {"raycast", "whitted", "path"}) {
      const Picture seen = rendered(two_squares(material, textures), assets, 64, technique);
      for (int x = 0; x < 64; ++x) {
        const double u = (x + 0.5) / 64, alpha = std::clamp(u, 0.25, 0.75);
        if (std::string(technique) == "path" && std::abs(alpha - cutoff) < 1.0 / 64) continue;
        EXPECT_EQ(seen.at(x, 20).y, alpha >= cutoff ? 1 : 0) << technique << " " << x << " " << cutoff;
        EXPECT_EQ(seen.at(x, 20).x, alpha >= cutoff ? 0 : 1) << technique << " " << x << " " << cutoff;
      }
    }
  }
}

// Without a cutoff, the mean over rays is opacity * front + (1 - opacity) * back, within 5 standard errors.
TEST(Opacity, BlendsWithWhatIsBehind) {
  for (const double opacity : {0.0, 0.3, 1.0}) {
    const Json material = {
        {"type", "lambert"}, {"reflectance", 0}, {"emission", {0, 1, 0}}, {"opacity", opacity}};
    const Picture seen = rendered(two_squares(material, Json::object()), AssetSource(), 32, "path", 16);
    double front = 0, back = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        front += double{seen.at(x, y).y} / (32 * 32);
        back += double{seen.at(x, y).x} / (32 * 32);
      }
    const double error = std::sqrt(opacity * (1 - opacity) / (32 * 32 * 16));
    EXPECT_NEAR(front, opacity, 5 * error + 1e-6);
    EXPECT_NEAR(back, 1 - opacity, 5 * error + 1e-6);
  }
}

// Layers of opacity a let (1 - a)^n of the light of a lamp pass to the floor, within 5 standard errors.
TEST(Opacity, LetsShadowRaysPass) {
  for (const int layers : {1, 3}) {
    Json scene = json(R"({
      'version': 1,
      'camera': {'type': 'orthographic', 'eye': [0, 0.5, 0], 'look_at': [0, 0, 0], 'up': [0, 0, -1], 'height': 1},
      'lights': [{'type': 'directional', 'direction_to_light': [0, 1, 0], 'intensity': [1, 1, 1]}],
      'objects': [{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'floor'}],
      'materials': {'floor': {'type': 'lambert', 'reflectance': 1},
                    'veil': {'type': 'lambert', 'reflectance': 0, 'opacity': 0.4}}})");
    for (int k = 0; k < layers; ++k) {
      Json veil = json("{'type': 'disk', 'normal': [0, 1, 0], 'radius': 3, 'material': 'veil'}");
      veil["center"] = {0, 1 + k, 0};
      scene["objects"].push_back(veil);
    }
    for (const char* technique : {"whitted", "path"}) {
      const int samples = 16;
      const Picture seen = rendered(scene, AssetSource(), 32, technique, samples);
      double light = 0;
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) light += double{seen.at(x, y).x} / (32 * 32);
      const double expected = std::pow(0.6, layers);
      EXPECT_NEAR(light, expected, 5 * std::sqrt(expected * (1 - expected) / (32 * 32 * samples)))
          << technique << " " << layers;
    }
  }
}

// A surface that all rays pass changes no pixel, for every shape, and in an instance.
TEST(Opacity, OfZeroLeavesNothing) {
  const char* const kObjects[] = {
      "{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.6}",
      "{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 1, 1], 'major_radius': 0.5, "
      "'minor_radius': 0.2}",
      "{'type': 'box', 'min': [-0.5, -0.5, -0.5], 'max': [0.5, 0.5, 0.5]}"};
  for (const char* object : kObjects)
    for (const bool in_instance : {false, true}) {
      Json scene = two_squares({{"type", "lambert"}, {"reflectance", 0.5}}, Json::object());
      const Picture without = rendered(scene, AssetSource(), 48, "whitted");
      Json placed = json(object);
      placed["material"] = "air";
      scene["materials"]["air"] = {{"type", "lambert"}, {"opacity", 0}};
      if (in_instance) {
        scene["models"]["m"]["objects"] = Json::array({placed});
        scene["instances"] = json("[{'model': 'm', 'scale': [1, 1.5, 1], 'translate': [0.1, 0, 0.7]}]");
      } else {
        scene["objects"].push_back(placed);
      }
      EXPECT_TRUE(identical(without, rendered(scene, AssetSource(), 48, "whitted"))) << object;
    }
}

TEST(Opacity, RejectsTexturesWithoutUvMapping) {
  const Json material = {{"type", "lambert"}, {"opacity", {{"texture", "t"}}}};
  const Json textures = {{"t", {{"type", "noise"}, {"mapping", {{"type", "solid"}}}}}};
  try {
    load_scene(square(material, textures).dump());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("must have the mapping uv"));
  }
}

}  // namespace
}  // namespace orrery::test
