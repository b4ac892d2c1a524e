#include <gtest/gtest.h>

#include <cmath>

#include "core/load/load.h"
#include "tests/support/pictures.h"
#include "tests/support/scenes.h"

namespace orrery::test {
namespace {

// Image that rises by 1 from the left to the right edge. Between the centres of its texels, the interpolated
// height is linear.
class Ramp final : public AssetSource {
 public:
  TexelsPtr picture_file(const std::string&) const override {
    Texels texels{4, 1, {}};
    for (int i = 0; i < 4; ++i)
      for (int c = 0; c < 3; ++c) texels.rgb.push_back(0.125f + 0.25f * static_cast<float>(i));
    return std::make_shared<const Texels>(std::move(texels));
  }
};

// A floor seen from above, in the light of two lights.
Json floor_with(const Json& material, const Json& textures, const Json& object) {
  Json scene = json(R"({
    'version': 1,
    'camera': {'type': 'orthographic', 'eye': [0, 3, 0], 'look_at': [0, 0, 0], 'up': [0, 0, -1], 'height': 1},
    'lights': [{'type': 'directional', 'direction_to_light': [-0.6, 1, 0.7], 'intensity': [0.6, 0.6, 0.6]},
               {'type': 'directional', 'direction_to_light': [0.9, 0.5, 0.1], 'intensity': [0, 0.4, 0.1]}]
  })");
  scene["materials"]["m"] = material;
  scene["textures"] = textures;
  Json placed = object;
  placed["material"] = "m";
  scene["objects"] = Json::array({placed});
  return scene;
}

// A height that rises linearly along x by `slope` tilts the normal as smooth normals of that direction do.
TEST(BumpMaps, TiltNormalsBySlopes) {
  const Ramp assets;
  for (const double slope : {0.1, -0.5, 1.5})
    for (const char* filter : {"pixel", "none"}) {
      const Json texture = {{"type", "image"},
                            {"file", "ramp"},
                            {"wrap", "clamp"},
                            {"filter", filter},
                            {"mapping", json("{'type': 'planar', 'origin': [-2, 0, -2], 'u_edge': [4, 0, 0], "
                                             "'v_edge': [0, 0, 4]}")}};
      const Json bumped = {
          {"type", "rough"}, {"kd", 0.8}, {"bump", {{"texture", "t"}, {"scale", 4 * slope}}}};
      const Json plane = json("{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}");
      Json quad = json(
          "{'type': 'mesh', 'positions': [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], "
          "'indices': [[0, 2, 1], [0, 3, 2]]}");
      const Vec3d tilted = safe_normalize(Vec3d(-slope, 1, 0));
      for (int k = 0; k < 4; ++k) quad["normals"].push_back(numbers(tilted));
      const RenderRequest request = in_double(size(24, 24));
      const Picture a =
          render(load_scene(floor_with(bumped, {{"t", texture}}, plane).dump(), assets), request);
      const Picture b = render(floor_with({{"type", "rough"}, {"kd", 0.8}}, Json::object(), quad), request);
      EXPECT_LT(largest_difference(a, b), 1e-6) << slope << " " << filter;
    }
}

TEST(BumpMaps, OfConstantHeightChangeNoByte) {
  const Json plane = json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.6}");
  const Json textures = {{"t", json("{'type': 'checker', 'even': 0.5, 'odd': 0.5}")}};
  const Picture a = render(floor_with({{"type", "rough"}, {"ks", 0.3}}, textures, plane), size(48, 48));
  const Picture b =
      render(floor_with({{"type", "rough"}, {"ks", 0.3}, {"bump", {{"texture", "t"}, {"scale", 1}}}},
                        textures, plane),
             size(48, 48));
  EXPECT_TRUE(identical(a, b));
}

// From inside, a surface shows its other side, and bumps become dents.
TEST(BumpMaps, RiseOutward) {
  const Ramp assets;
  const Json texture = {{"type", "image"},
                        {"file", "ramp"},
                        {"mapping", json("{'type': 'planar', 'origin': "
                                         "[-2, 0, -2], 'u_edge': [4, 0, 0], 'v_edge': [0, 0, 4]}")}};
  const auto seen_normal = [&](double up) {
    Json scene = floor_with({{"type", "rough"}, {"bump", {{"texture", "t"}, {"scale", 4}}}}, {{"t", texture}},
                            {{"type", "plane"}, {"point", {0, 0, 0}}, {"normal", {0, up, 0}}});
    scene["lights"] =
        json("[{'type': 'directional', 'direction_to_light': [-1, 1, 0], 'intensity': [1, 1, 1]}]");
    return double{render(load_scene(scene.dump(), assets), in_double(size(8, 8))).at(4, 4).x};
  };
  EXPECT_NEAR(seen_normal(1), 0.8, 1e-6);  // the slope of 1 faces the light
  EXPECT_NEAR(seen_normal(-1), 0, 1e-6);   // the normal is perpendicular to the light
}

TEST(BumpMaps, AreFiniteOnEveryShapeAndMapping) {
  for (const char* object :
       {"{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.6}",
        "{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 1, 0], 'major_radius': 0.4, 'minor_radius': 0.1}",
        "{'type': 'cone', 'base': [0, -0.5, 0], 'top': [0, 0.5, 0], 'base_radius': 0.5}",
        "{'type': 'triangle', 'vertices': [[-1, 0, 0.5], [1, 0, 0.5], [0, 0, -1]]}"})
    for (const char* mapping : {"uv", "planar", "spherical", "cylindrical", "solid"}) {
      const Json textures = {{"t", {{"type", "noise"}, {"octaves", 3}, {"mapping", {{"type", mapping}}}}}};
      const Json material = {{"type", "rough"}, {"bump", {{"texture", "t"}, {"scale", 0.3}}}};
      const Picture picture = render(floor_with(material, textures, json(object)), size(48, 48));
      EXPECT_LT(largest_difference(picture, picture), 1) << object << " " << mapping;
      EXPECT_GT(picture.brighter_than(0.05f), 20) << object << " " << mapping;
    }
}

}  // namespace
}  // namespace orrery::test
