#include "server/api/view_scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/image/encode/files.h"
#include "core/load/load.h"
#include "core/model/model_images.h"
#include "core/params/json.h"
#include "tests/meshes/writers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// Images of glTF models, through the scene that a view writes.
namespace orrery {
namespace {

using Code = std::array<unsigned char, 3>;

// Returns the light of a code (IEC 61966-2-1).
double light_of(unsigned char code) {
  const double x = code / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// Square image of random codes.
struct Card {
  int side;
  std::vector<Code> codes;  // top row first

  explicit Card(int of_side) : side(of_side) {
    test::Random random(7);
    for (int i = 0; i < side * side; ++i) {
      const auto code = [&] { return static_cast<unsigned char>(random.unit() * 256); };
      codes.push_back({code(), code(), code()});
    }
  }
  const Code& at(int x, int y) const { return codes[static_cast<std::size_t>(y * side + x)]; }
  std::string png() const {
    Image image(side, side, PixelFormat::srgb8);
    std::memcpy(image.bytes().data(), codes.data(), codes.size() * 3);
    return encode_png(image);
  }
};

// Returns the model of a square of side 2 that faces +z. Its texture coordinates are from 0 to `repeats`,
// with (0, 0) at the upper left, as in glTF. `material`: members of the material. `rest`: other members.
MeshModel card_model(const Card& card, double repeats, const std::string& material,
                     const std::string& rest = "") {
  test::Gltf gltf;
  gltf.positions({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const auto r = static_cast<float>(repeats);
  gltf.add<float>({0, r, r, r, r, 0, 0, 0}, "VEC2", 5126);
  gltf.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
  return read_model(gltf.glb(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,)"
      R"("material":0}]}],"materials":[{)" +
      material + R"(}],"images":[{"uri":"data:image/png;base64,)" + test::base64_of(card.png()) + "\"}]" +
      rest));
}

// Returns the scene of a view of the model at rest.
nlohmann::ordered_json scene_of(const MeshModel& model, const ViewOptions& options = {}, int side = 64) {
  return view_scene({{{}, std::make_shared<const MeshModel>(model)}}, {"file", "model", "Model"}, options,
                    side, side);
}

// Renders the front of a model without perspective, one sample at the centre of each pixel. The margin is a
// 20th of the image on each side.
test::Picture front_of(const MeshModel& model, int side) {
  ViewOptions options;
  options.orthographic = true;
  const nlohmann::ordered_json scene = scene_of(model, options, side);
  RenderRequest request = test::in_double(test::size(side, side));
  request.technique = "raycast";
  request.samples = 1;
  const auto shared = std::make_shared<const MeshModel>(model);
  return test::render(load_scene(document_of(scene), OneModel(shared)), request);
}

const std::string kUnlit =
    R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"extensions":{"KHR_materials_unlit":{}})";

void expect_codes(const test::Picture& seen, const std::function<const Code&(int x, int y)>& code_at) {
  const int side = seen.width - seen.width / 10, margin = seen.width / 20;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Vec3f& light = seen.at(margin + x, margin + y);
      const Code& code = code_at(x, y);
      ASSERT_NEAR(double{light.x}, light_of(code[0]), 2e-6) << x << ' ' << y;
      ASSERT_NEAR(double{light.y}, light_of(code[1]), 2e-6) << x << ' ' << y;
      ASSERT_NEAR(double{light.z}, light_of(code[2]), 2e-6) << x << ' ' << y;
    }
}

// With one texel for each pixel, an unlit texture shows its codes, upright and not mirrored.
TEST(ViewScene, ShowsTexelsOfUnlitMaterials) {
  const Card card(18);
  const MeshModel model = card_model(card, 1, kUnlit, R"(,"textures":[{"source":0}])");
  expect_codes(front_of(model, 20), [&](int x, int y) -> const Code& { return card.at(x, y); });
}

// Three repetitions of a card of 6 texels along u and v, which may wrap differently.
TEST(ViewScene, WrapsTexturesAsSamplersState) {
  const Card card(6);
  const std::pair<int, std::function<int(int)>> modes[] = {
      {10497, [](int i) { return i % 6; }},
      {33648, [](int i) { return i / 6 % 2 == 1 ? 5 - i % 6 : i % 6; }},
      {33071, [](int i) { return std::min(i, 5); }}};
  for (const auto& [u, along_u] : modes)
    for (const auto& [v, along_v] : modes) {
      const MeshModel model = card_model(card, 3, kUnlit,
                                         R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":)" +
                                             std::to_string(u) + R"(,"wrapT":)" + std::to_string(v) + "}]");
      expect_codes(front_of(model, 20),
                   [&](int x, int y) -> const Code& { return card.at(along_u(x), along_v(y)); });
    }
}

// KHR_texture_transform with a rotation of a quarter maps (u, v) of glTF to (v, 1 - u), moved back by its
// offset: texel (x, y) appears at the place where (v, -u + 1) is its place.
TEST(ViewScene, TurnsTextures) {
  const Card card(18);
  const std::string material =
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":)"
      R"({"rotation":1.5707963267948966,"offset":[0,1]}}}},"extensions":{"KHR_materials_unlit":{}})";
  const MeshModel model = card_model(card, 1, material, R"(,"textures":[{"source":0}])");
  expect_codes(front_of(model, 20), [&](int x, int y) -> const Code& { return card.at(y, 17 - x); });
}

TEST(ViewScene, UsesCamerasAndLightsOfTheFile) {
  const Card card(2);
  const MeshModel model = card_model(
      card, 1, R"("name":"m")",
      R"(,"cameras":[{"name":"near","type":"perspective","perspective":{"yfov":0.5,"znear":0.1}},)"
      R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":1.5,"znear":0,"zfar":9}}])"
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":6.283185307179586}]}})");
  EXPECT_TRUE(model.cameras.empty());  // no node has a camera
  ViewOptions options;
  options.camera = "near";
  EXPECT_THROW(scene_of(model, options), InputError);
  options.camera.clear();
  options.file_light = true;
  EXPECT_THROW(scene_of(model, options), InputError);

  MeshModel with_both = model;
  with_both.cameras = {{"near", {0, 0, 4}, {0, 0, -1}, {0, 1, 0}, 30, 0},
                       {"flat", {0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 0, 3}};
  ModelLight light{ModelLight::Kind::point, {0, 0, 2}, {0, 0, -1}, Vec3d(8 * std::numbers::pi)};
  with_both.lights = {light};
  for (const char* camera : {"near", "1"}) {
    options.camera = camera;
    const auto scene = scene_of(with_both, options);
    EXPECT_EQ(scene["camera"]["type"], camera[0] == 'n' ? "perspective" : "orthographic");
    EXPECT_EQ(scene["camera"]["look_at"], (nlohmann::ordered_json{0.0, 0.0, 0.0}));
    EXPECT_EQ(scene["lights"].size(), 1);
    EXPECT_EQ(scene["lights"][0]["intensity"][0], 8.0);
  }
}

TEST(ViewScene, OmitsGroundAboveTheCameraOfTheFile) {
  MeshModel model = card_model(Card(2), 1, R"("name":"m")");
  ViewOptions options;
  options.ground = ViewOptions::Ground::shadow;
  options.camera = "0";
  const auto objects_from = [&](double height) {
    model.cameras = {{"0", {0, height, 4}, {0, 0, -1}, {0, 1, 0}, 30, 0}};
    return scene_of(model, options)["objects"].size();
  };
  EXPECT_EQ(objects_from(3), 2);
  EXPECT_EQ(objects_from(-3), 1);
}

// A square of side 1 that moves by 4 along x within 2 s. The view frames all places: from -0.5 to 4.5, in a
// square image with a margin of 5 %.
TEST(ViewScene, PlaysAnimations) {
  test::Gltf gltf;
  gltf.positions({{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}});
  gltf.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
  gltf.add<float>({0, 2}, "SCALAR", 5126);
  gltf.add<float>({0, 0, 0, 4, 0, 0}, "VEC3", 5126);
  const std::string glb = test::replaced(
      gltf.glb(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
               R"("material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
               R"("textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
               test::base64_of(Card(2).png()) +
               R"("}],"animations":[{"name":"slide","samplers":[{"input":2,"output":3}],)"
               R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])"),
      R"("count":2,"type":"SCALAR"})", R"("count":2,"type":"SCALAR","max":[2]})");
  const auto read = [&](const ModelState& state) {
    return std::make_shared<const MeshModel>(read_model(glb, {}, {}, state));
  };
  ViewOptions options;
  options.orthographic = options.plays = true;
  options.state.pose = ModelPose{0, 0};
  const ModelStates states = read_states(options, read);
  ASSERT_EQ(states.size(), 49);  // 24 per second
  EXPECT_EQ(states.begin()->second->images.size(), 1);
  EXPECT_TRUE(std::next(states.begin())->second->images.empty());
  const auto scene = view_scene(states, {"file", "model", "Model"}, options, 200, 200);
  ASSERT_EQ(scene["objects"][0]["motion"].size(), 49);
  EXPECT_EQ(scene["objects"][0]["motion"][48]["pose_time"], 2.0);
  const auto loaded = load_scene(document_of(scene), OneModel(states));
  for (const double time : {0.0, 0.51, 2.0}) {
    RenderRequest request = test::in_double(test::size(200, 200));
    request.technique = "raycast";
    request.samples = 1;
    request.time = time;
    const test::Picture picture = test::render(loaded, request);
    int first = 200, last = -1;
    for (int x = 0; x < 200; ++x)
      if (picture.at(x, 100) != picture.at(100, 2)) {
        first = std::min(first, x);
        last = std::max(last, x);
      }
    EXPECT_NEAR(first, 10 + 180 * (2 * time) / 5, 1) << time;
    EXPECT_NEAR(last + 1, 10 + 180 * (2 * time + 1) / 5, 1) << time;
  }
  options.state.pose->animation = 1;
  EXPECT_THROW(read_states(options, read), InputError);
}

TEST(ViewScene, PlaysNothingWithoutAnimations) {
  ViewOptions options;
  options.plays = true;
  options.state.pose = ModelPose{0, 0};
  const auto read = [](const ModelState& state) {
    EXPECT_EQ(state, ModelState());
    return std::make_shared<const MeshModel>(card_model(Card(2), 1, R"("name":"m")"));
  };
  const auto scene = view_scene(read_states(options, read), {"file", "model", "Model"}, options, 64, 64);
  EXPECT_FALSE(scene["objects"][0].contains("motion"));
  EXPECT_FALSE(scene["objects"][0].contains("pose_time"));
}

// A triangle that shrinks to nothing and comes back mirrored, one without duration, and one whose keyframes
// are not ascending are shown at rest.
TEST(ViewScene, KeepsModelsAtRestWhoseAnimationsCannotBePlayed) {
  const auto states_of = [](const std::vector<float>& times, const std::string& last) {
    test::Gltf gltf;
    gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    gltf.add<float>(times, "SCALAR", 5126);
    gltf.add<float>({1, 1, 1, -1, 1, 1}, "VEC3", 5126);
    const std::string glb = test::replaced(
        gltf.glb(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                 R"("animations":[{"samplers":[{"input":1,"output":2}],)"
                 R"("channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}])"),
        R"("count":2,"type":"SCALAR"})", R"("count":2,"type":"SCALAR","max":[)" + last + "]}");
    ViewOptions options;
    options.plays = true;
    options.state.pose = ModelPose{0, 0};
    return read_states(options, [&](const ModelState& state) {
      return std::make_shared<const MeshModel>(read_model(glb, {}, {}, state));
    });
  };
  for (const ModelStates& states : {states_of({0, 2}, "2"), states_of({0, 2}, "0"), states_of({2, 0}, "2")}) {
    ASSERT_EQ(states.size(), 1);
    EXPECT_EQ(states.begin()->first, ModelState());
    EXPECT_EQ(notes_of(*states.begin()->second),
              std::vector<std::string>{"the model is at rest, without its animation"});
  }
}

TEST(ViewScene, MakesGlassOfTransmittingVolumes) {
  const Card card(2);
  const auto material_of = [&](const std::string& extensions) {
    const MeshModel model = card_model(card, 1, R"("extensions":{)" + extensions + "}");
    return scene_of(model)["materials"]["material"];
  };
  const auto glass = material_of(
      R"("KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.33},)"
      R"("KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":0.5,"attenuationColor":[0.5,1,0.25]})");
  EXPECT_EQ(glass["type"], "glass");
  EXPECT_EQ(glass["ior"], 1.33);
  EXPECT_NEAR(glass["filter"][0].get<double>(), 0.25, 1e-15);
  EXPECT_NEAR(glass["filter"][2].get<double>(), 0.0625, 1e-15);
  const auto pane = material_of(R"("KHR_materials_transmission":{"transmissionFactor":0.75})");
  EXPECT_EQ(pane["type"], "transparent");
  EXPECT_EQ(pane["kt"], 0.75);
}

TEST(ViewScene, CoatsMaterials) {
  const MeshModel model = card_model(
      Card(2), 1,
      R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.25,)"
      R"("clearcoatTexture":{"index":0},"clearcoatNormalTexture":{"index":0},)"
      R"("clearcoatRoughnessTexture":{"index":0}},)"
      R"("KHR_materials_sheen":{"sheenColorFactor":[1,0.5,0.25],"sheenColorTexture":{"index":0},)"
      R"("sheenRoughnessFactor":0.5},"KHR_materials_specular":{"specularFactor":0.5,)"
      R"("specularTexture":{"index":0}}})",
      R"(,"textures":[{"source":0}])");
  const auto scene = scene_of(model);
  const auto& json = scene["materials"]["material"];
  EXPECT_EQ(json["type"], "coated");
  EXPECT_EQ(json["coat"]["channel"], "red");
  EXPECT_EQ(json["coat"]["scale"], 0.75);
  EXPECT_EQ(json["coat_roughness"], 0.25);
  EXPECT_EQ(json["sheen_color"]["tint"], (nlohmann::ordered_json{1.0, 0.5, 0.25}));
  EXPECT_EQ(json["sheen_roughness"], 0.5);
  const std::string shine = json["normal_reflectance"]["texture"], cloth = json["sheen_color"]["texture"];
  EXPECT_EQ(scene["textures"][shine]["encoding"], "alpha");
  EXPECT_EQ(scene["textures"][cloth]["encoding"], "srgb");
  EXPECT_EQ(json["normal_reflectance"]["tint"][0], 0.02);
  EXPECT_EQ(
      notes_of(model),
      (std::vector<std::string>{"1 textures of KHR_materials_clearcoat are not modelled",
                                "1 materials have a clear coat with other normals, which are not modelled"}));
}

// Returns a model of `count` triangles, each with a material of its own, without names.
MeshModel model_of_materials(int count) {
  MeshModel model;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(3 * i);
    for (const Vec3d& corner : {Vec3d(i, 0, 0), Vec3d(i + 1, 0, 0), Vec3d(i, 1, 0)})
      model.mesh.positions.push_back(corner);
    model.mesh.triangles.push_back({first, first + 1, first + 2});
    model.mesh.parts.push_back({static_cast<std::uint32_t>(i), i, false, true, false});
  }
  model.mesh.uvs.resize(model.mesh.positions.size());
  model.materials.resize(static_cast<std::size_t>(count));
  return model;
}

// The time is proportional to the number: the square of 40,000 would take minutes.
TEST(ViewScene, NamesManyMaterials) {
  constexpr int kCount = 40'000;
  const auto start = std::chrono::steady_clock::now();
  const auto scene = scene_of(model_of_materials(kCount));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  ASSERT_EQ(scene["materials"].size(), kCount);
  EXPECT_EQ(scene["objects"][0]["material"], "material");
  EXPECT_EQ(scene["objects"][1]["material"], "material 2");
  EXPECT_EQ(scene["objects"][kCount - 1]["material"], "material 40000");
}

TEST(ViewScene, RejectsModelsOfTooManyTextures) {
  MeshModel model = model_of_materials(257);
  model.images = {{"card", std::make_shared<const std::string>(Card(2).png())}};
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    ModelTexture texture;
    texture.shift = {static_cast<double>(i), 0};
    model.materials[i].base_color.texture = texture;
  }
  const auto view = [&] { return scene_of(model); };
  try {
    view();
    FAIL() << "257 textures were accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 256 textures"), std::string::npos) << error.what();
  }
  model.materials[256] = model.materials[0];
  EXPECT_EQ(view()["textures"].size(), 256);
}

// Viewers show the factors of a material whose image has another format, such as KTX or BMP.
TEST(ViewScene, LeavesOutImagesOfUnknownFormats) {
  MeshModel model = model_of_materials(1);
  model.images = {{"card.png", std::make_shared<const std::string>(Card(2).png())},
                  {"card.bmp", std::make_shared<const std::string>("BM, not decoded")}};
  ModelMaterial& material = model.materials[0];
  material.base_color = {Vec3d(0.25), ModelTexture{.image = 1}};
  material.emission = {Vec3d(1), ModelTexture{.image = 0}};
  material.normal = {1, ModelTexture{.image = 1}};
  const auto scene = scene_of(model);
  const auto& json = scene["materials"]["material"];
  EXPECT_EQ(json["base_color"], (nlohmann::ordered_json{0.25, 0.25, 0.25}));
  EXPECT_TRUE(json["emission"].contains("texture"));
  EXPECT_FALSE(json.contains("normal_map"));
  EXPECT_EQ(notes_of(model),
            (std::vector<std::string>{
                "image \"card.bmp\" is not shown: it must be an EXR, Radiance HDR, PNG, JPEG or WebP file"}));
}

}  // namespace
}  // namespace orrery
