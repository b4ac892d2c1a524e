#include <gtest/gtest.h>

#include <cmath>

#include "core/load/load.h"
#include "core/textures/registry.h"
#include "tests/support/pictures.h"
#include "tests/support/scenes.h"

namespace orrery::test {
namespace {

// Serves one image under every name.
class OneImage final : public AssetSource {
 public:
  explicit OneImage(Texels texels) : texels_(std::make_shared<const Texels>(std::move(texels))) {}
  TexelsPtr picture_file(const std::string&) const override { return texels_; }

 private:
  TexelsPtr texels_;
};

Texels constant_texels(const Vec3f& color) {
  Texels texels{4, 3, {}};
  for (int i = 0; i < 12; ++i) texels.rgb.insert(texels.rgb.end(), {color.x, color.y, color.z});
  return texels;
}

// Returns a texture of a registered type whose value is `color` everywhere.
Json constant_texture(const std::string& type, const Vec3d& color) {
  Json texture = {{"type", type}};
  if (type == "image")
    texture["file"] = "constant";
  else if (type == "uniform")
    texture["color"] = numbers(color);
  else
    for (const char* key : type == "checker"  ? std::array{"even", "odd"}
                           : type == "marble" ? std::array{"stone", "vein"}
                           : type == "wood"   ? std::array{"early", "late"}
                                              : std::array{"low", "high"})
      texture[key] = numbers(color);
  return texture;
}

// A ball, a tilted box in an instance, and a floor to the horizon.
Json stage(const Json& material, const Json& textures = Json::object()) {
  Json scene = json(R"({
    'version': 1,
    'camera': {'type': 'perspective', 'eye': [0, 1.6, 6], 'look_at': [0, 0.9, 0], 'fov_degrees': 40},
    'ambient': [0.2, 0.2, 0.2], 'background': [0.1, 0.2, 0.3],
    'lights': [{'type': 'directional', 'direction_to_light': [-0.6, 1, 0.7], 'intensity': [0.8, 0.7, 0.6]}],
    'objects': [
      {'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'm'},
      {'type': 'sphere', 'center': [-1.2, 0.9, 0], 'radius': 0.9, 'material': 'm'}],
    'models': {'box': {'objects': [{'type': 'box', 'min': [-0.6, 0, -0.6], 'max': [0.6, 1.2, 0.6], 'material': 'm'}]}},
    'instances': [{'model': 'box', 'rotate': {'degrees': 30}, 'translate': [1.2, 0, 0]}]
  })");
  scene["materials"]["m"] = material;
  scene["textures"] = textures;
  return scene;
}

std::shared_ptr<const Scene> load_with(const Json& scene, const AssetSource& assets) {
  return load_scene(scene.dump(), assets);
}

const OneImage kGrey(constant_texels(Vec3f(0.5f, 0.25f, 0.125f)));
const Vec3d kColor(0.5, 0.25, 0.125);

class TextureTypes : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(All, TextureTypes, [] {
  std::vector<std::string> names;
  for (const TextureType& type : texture_types()) names.emplace_back(type.name);
  return testing::ValuesIn(names);
}());

// Constant textures give the bytes of the colour, with every mapping, filter and technique.
TEST_P(TextureTypes, GiveTheBytesOfAColourIfConstant) {
  for (const char* technique : {"raycast", "whitted", "path"}) {
    RenderRequest request = size(64, 48);
    request.technique = technique;
    request.samples = 2;
    const Picture plain = render(stage({{"type", "lambert"}, {"reflectance", numbers(kColor)}}), request);
    for (const char* mapping :
         {"{'type': 'uv', 'repeat_u': 7}", "{'type': 'planar'}", "{'type': 'spherical'}",
          "{'type': 'cylindrical'}", "{'type': 'solid', 'size': 0.2}", "{'type': 'solid', 'space': 'world'}"})
      for (const char* filter : {"pixel", "none"}) {
        Json texture = constant_texture(GetParam(), kColor);
        texture["mapping"] = json(mapping);
        texture["filter"] = filter;
        const Json material = {{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}};
        const Picture textured = render(load_with(stage(material, {{"t", texture}}), kGrey), request);
        EXPECT_TRUE(identical(plain, textured)) << technique << " " << mapping << " " << filter;
      }
  }
}

TEST_P(TextureTypes, DifferFromAColourAndAreFinite) {
  Texels varied = constant_texels(Vec3f(0.5f));
  varied.rgb[7] = 0.9f;
  const OneImage image(varied);
  Json texture = {{"type", GetParam()}};
  if (GetParam() == "image") texture["file"] = "varied";
  texture["mapping"] = json("{'type': 'spherical', 'repeat_u': 4, 'repeat_v': 4}");
  const Json material = {{"type", "rough"}, {"kd", {{"texture", "t"}}}};
  const Picture picture = render(load_with(stage(material, {{"t", texture}}), image), size(64, 48));
  const Picture again = render(load_with(stage(material, {{"t", texture}}), image), in_double(size(64, 48)));
  const Picture white = render(stage({{"type", "rough"}, {"kd", 0.5}}), size(64, 48));
  EXPECT_GT(differing_pixels(picture, white, 0.01), 50);
  EXPECT_LT(largest_difference(picture, again), 0.02);
}

TEST_P(TextureTypes, HaveEqualBytesInScenesScaledByAPowerOfTwo) {
  Json texture = constant_texture(GetParam(), kColor);
  if (GetParam() != "image") texture.erase(texture.begin());  // a key of a colour
  texture["type"] = GetParam();
  texture["mapping"] = json("{'type': 'solid', 'size': 0.25}");
  const auto at_scale = [&](double factor) {
    Json scene = stage({{"type", "rough"}, {"kd", {{"texture", "t"}}}}, {{"t", texture}});
    scene.erase("instances");
    scene.erase("models");
    scene = scaled(scene, factor);
    scene["textures"]["t"]["mapping"]["size"] = 0.25 * factor;
    return render(load_with(scene, kGrey), size(64, 48));
  };
  EXPECT_TRUE(identical(at_scale(1), at_scale(1024)));
}

// Every parameter of every material that may be textured.
struct Parameter {
  const char* material;
  const char* key;
  double value;
  double tolerance;
};

class TexturedParameters : public testing::TestWithParam<Parameter> {};

INSTANTIATE_TEST_SUITE_P(
    All, TexturedParameters,
    testing::Values(Parameter{"{'type': 'rough', 'ks': 0.2}", "kd", 0.5, 0},
                    Parameter{"{'type': 'rough'}", "ka", 0.5, 0},
                    Parameter{"{'type': 'rough'}", "ks", 0.5, 0},
                    Parameter{"{'type': 'rough'}", "diffuse_color", 0.5, 0},
                    Parameter{"{'type': 'rough', 'ks': 0.5}", "specular_color", 0.5, 0},
                    Parameter{"{'type': 'rough', 'ks': 0.5}", "shininess", 12, 0},
                    Parameter{"{'type': 'reflective', 'k': [3, 3, 3]}", "n", 0.25, 1e-6},
                    Parameter{"{'type': 'reflective', 'n': [0.25, 0.25, 0.25]}", "k", 3, 1e-6},
                    Parameter{"{'type': 'lambert'}", "reflectance", 0.5, 0},
                    Parameter{"{'type': 'oren-nayar', 'roughness': 0.75}", "reflectance", 0.5, 1e-6},
                    Parameter{"{'type': 'oren-nayar'}", "roughness", 0.25, 1e-6},
                    Parameter{"{'type': 'metal', 'k': [3, 3, 3]}", "n", 0.25, 2e-3},
                    Parameter{"{'type': 'metal', 'n': [0.25, 0.25, 0.25]}", "k", 3, 2e-3},
                    Parameter{"{'type': 'glass'}", "filter", 0.5, 1e-6},
                    Parameter{"{'type': 'plastic'}", "reflectance", 0.5, 1e-6},
                    Parameter{"{'type': 'metallic-roughness'}", "base_color", 0.5, 1e-6},
                    Parameter{"{'type': 'coated'}", "coat", 0.5, 1e-6},
                    Parameter{"{'type': 'coated', 'coat': 1}", "sheen_color", 0.5, 1e-6},
                    Parameter{"{'type': 'coated', 'coat': 1, 'sheen_color': 0.5}", "roughness", 0.25, 1e-3},
                    Parameter{"{'type': 'metallic-roughness', 'base_color': 0.5}", "metallic", 0.25, 1e-6},
                    Parameter{"{'type': 'cook-torrance', 'diffuse': 0.25}", "n", 1.5, 1e-6},
                    Parameter{"{'type': 'cook-torrance', 'diffuse': 0.25}", "k", 0.5, 1e-6},
                    Parameter{"{'type': 'cook-torrance'}", "diffuse", 0.25, 1e-6},
                    Parameter{"{'type': 'cook-torrance'}", "specular", 0.5, 1e-6},
                    Parameter{"{'type': 'cook-torrance', 'diffuse': 0.5}", "slope", 0.25, 1e-6},
                    Parameter{"{'type': 'metal', 'name': 'gold'}", "roughness", 0.5, 1e-3},
                    Parameter{"{'type': 'glass'}", "roughness", 0.5, 1e-3},
                    Parameter{"{'type': 'plastic'}", "roughness", 0.5, 1e-3},
                    Parameter{"{'type': 'metallic-roughness'}", "roughness", 0.25, 1e-3},
                    Parameter{"{'type': 'translucent'}", "reflectance", 0.5, 1e-6},
                    Parameter{"{'type': 'translucent'}", "transmittance", 0.25, 1e-6}));

// Returns `value` as the type of parameter requires. Colours are tried first.
Json with_value(Json material, const char* key, double value) {
  material[key] = Json::array({value, value, value});
  if (first_problem(stage(material)) != "accepted") material[key] = value;
  return material;
}

TEST_P(TexturedParameters, AgreeWithUntexturedParameters) {
  const auto& [material, key, value, tolerance] = GetParam();
  const Json plain = with_value(json(material), key, value);
  Json textured = json(material);
  textured[key] = {{"texture", "t"}, {"scale", value}};
  const Json textures = {
      {"t", json("{'type': 'checker', 'even': 1, 'odd': 1, 'mapping': {'type': 'solid'}}")}};
  for (const char* technique : {"whitted", "path"}) {
    RenderRequest request = size(48, 36);
    request.technique = technique;
    request.samples = 4;
    const Picture a = render(stage(plain), request), b = render(stage(textured, textures), request);
    if (tolerance == 0)
      EXPECT_TRUE(identical(a, b)) << technique;
    else
      EXPECT_LE(differing_pixels(a, b, tolerance * 20), 2) << technique;
  }
}

TEST_P(TexturedParameters, RejectValuesOutOfRange) {
  const auto& [material, key, value, tolerance] = GetParam();
  Json textured = json(material);
  textured[key] = {{"texture", "t"}, {"scale", -1e6}, {"offset", -1}};
  const Json textures = {{"t", {{"type", "checker"}}}};
  EXPECT_EQ(first_problem(stage(textured, textures)), std::string("/materials/m/") + key);
}

// Two materials of one type, one of which is textured, in the same registers.
TEST(Textures, ChangeOnlyTheMaterialsThatUseThem) {
  Json scene =
      stage({{"type", "oren-nayar"}, {"reflectance", {{"texture", "t"}}}}, {{"t", {{"type", "checker"}}}});
  scene["materials"]["plain"] = json("{'type': 'oren-nayar', 'reflectance': 0.3}");
  scene["objects"][1]["material"] = "plain";
  Json other = scene;
  other["materials"]["m"] = json("{'type': 'oren-nayar'}");
  const Picture a = render(scene, size(160, 120)), b = render(other, size(160, 120));
  EXPECT_EQ(a.at(52, 55), b.at(52, 55));  // ball
  EXPECT_GT(differing_pixels(a, b, 0.01), 1000);
}

TEST(Textures, AverageTheFloorTowardTheHorizon) {
  Json scene = stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}},
                     {{"t", json("{'type': 'checker', 'mapping': {'type': 'planar', 'u_edge': [0.1, 0, 0], "
                                 "'v_edge': [0, 0, 0.1]}}")}});
  scene.erase("instances");
  scene["objects"].erase(1);
  scene["ambient"] = json("[1, 1, 1]");
  scene["lights"] = Json::array();
  const Picture far = render(scene, size(200, 150));
  int row = 0;
  while (far.at(100, row).x == 0.1f) ++row;  // the first row below the horizon
  for (int x = 0; x < 200; ++x) EXPECT_NEAR(far.at(x, row + 1).x, 0.5, 0.05) << x;
}

TEST(Textures, FollowInstancesUnlessInWorldSpace) {
  const auto with_space = [](const char* space, double shift) {
    Json texture =
        json("{'type': 'checker', 'mapping': {'type': 'solid', 'size': 0.35, 'origin': [0.1, 0.1, 0.1]}}");
    texture["mapping"]["space"] = space;
    Json scene = stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}}, {{"t", texture}});
    scene["objects"] = Json::array();
    scene["instances"] = Json::array({{{"model", "box"}, {"translate", {shift, 0, 0}}}});
    scene["camera"]["eye"] = {shift, 1.6, 6};
    scene["camera"]["look_at"] = {shift, 0.9, 0};
    return render(scene, in_double(size(80, 60)));
  };
  EXPECT_LE(differing_pixels(with_space("object", 0), with_space("object", 0.5), 0.01), 5);
  EXPECT_GT(differing_pixels(with_space("world", 0), with_space("world", 0.5), 0.01), 200);
}

TEST(Textures, FollowInstancesThatMoveDuringTheExposure) {
  Json scene = stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}},
                     {{"t", json("{'type': 'checker', 'mapping': {'type': 'solid', 'size': 0.25}}")}});
  scene["objects"] = Json::array();
  scene["background"] = json("[0, 0, 0]");
  scene["instances"] = json(
      "[{'model': 'box', 'motion': [{'time': 0, 'translate': [0, 0, 0]}, "
      "{'time': 1, 'translate': [0.0001, 0, 0]}]}]");
  RenderRequest request = in_double(size(80, 60));
  request.shutter = 1;
  request.samples = 4;
  const Picture moving = render(scene, request);
  scene["instances"] = json("[{'model': 'box'}]");
  request.shutter = std::nullopt;
  EXPECT_LE(differing_pixels(moving, render(scene, request), 0.02), 40);
}

TEST(Textures, BoundTheRadianceOfTexturedSurfaces) {
  const Json textures = {{"t", json("{'type': 'checker', 'even': [0.9, 0.2, 0.1], 'odd': [0.1, 0.3, 0.8]}")}};
  const auto scene = load(stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}}}}, textures));
  EXPECT_EQ(scene->facts.albedo, Vec3d(0.9, 0.3, 0.8));
  const auto scaled_down =
      load(stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}, {"scale", -0.5}, {"offset", 0.5}}}},
                 textures));
  EXPECT_LT(length(scaled_down->facts.albedo - Vec3d(0.45, 0.4, 0.45)), 1e-15);
}

TEST(Textures, ReadChannels) {
  const Json textures = {
      {"t", json("{'type': 'checker', 'even': [0.75, 0.5, 0.25], 'odd': [0.75, 0.5, 0.25]}")}};
  const auto albedo = [&](const char* channel) {
    return load(stage({{"type", "lambert"}, {"reflectance", {{"texture", "t"}, {"channel", channel}}}},
                      textures))
        ->facts.albedo;
  };
  EXPECT_EQ(albedo("rgb"), Vec3d(0.75, 0.5, 0.25));
  EXPECT_EQ(albedo("red"), Vec3d(0.75));
  EXPECT_EQ(albedo("green"), Vec3d(0.5));
  EXPECT_EQ(albedo("blue"), Vec3d(0.25));
  EXPECT_NEAR(albedo("luminance").x, 0.2126 * 0.75 + 0.7152 * 0.5 + 0.0722 * 0.25, 1e-15);
}

TEST(Textures, CostNothingInScenesThatDoNotUseThem) {
  Json scene = stage({{"type", "lambert"}}, {{"t", {{"type", "checker"}}}});
  const auto loaded = load(scene);
  EXPECT_TRUE(loaded->texture_uses.empty());
  EXPECT_FALSE(loaded->facts.materials.fields.footprint || loaded->facts.materials.fields.parameters ||
               loaded->facts.materials.fields.identity);
}

TEST(Textures, ReportUnknownNamesAndChannels) {
  const auto problem = [](const char* use) {
    Json material = {{"type", "oren-nayar"}};
    material["roughness"] = json(use);
    return first_problem(stage(material, {{"t", {{"type", "checker"}}}}));
  };
  EXPECT_EQ(problem("{'texture': 't'}"), "accepted");
  EXPECT_EQ(problem("{'texture': 's'}"), "/materials/m/roughness/texture");
  EXPECT_EQ(problem("{'texture': 't', 'channel': 'rgb'}"), "/materials/m/roughness/channel");
  EXPECT_EQ(problem("{'texture': 't', 'scale': 2}"), "/materials/m/roughness");
  EXPECT_EQ(problem("{'textur': 't'}"), "/materials/m/roughness");
}

}  // namespace
}  // namespace orrery::test
