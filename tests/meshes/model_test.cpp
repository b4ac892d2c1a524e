#include "core/meshes/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/writers.h"

namespace orrery::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<Vec3d> kOneTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

// Returns a glTF model of three triangles with the materials 1, none and 1. The first has normals and
// colours, and the first and second have texture coordinates. `members`: other members of the document.
MeshModel three_parts(const std::string& members, const ReadNearby& nearby = {}) {
  Gltf gltf;
  gltf.positions(kOneTriangle);
  gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
  gltf.add<float>({0, 0, 1, 0, 0, 1}, "VEC2", 5126);
  gltf.add<float>({1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1}, "VEC4", 5126);
  return read_model(gltf.glb(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3},"material":1},
{"attributes":{"POSITION":0,"TEXCOORD_0":2}},
{"attributes":{"POSITION":0},"material":1}]}])" +
                             members),
                    {}, nearby);
}

TEST(Model, KeepsPartsByMaterial) {
  const MeshModel model = three_parts(R"(,"materials":[{"name":"a"},{"name":"b"}])");
  EXPECT_EQ(model.mesh.triangles.size(), 3);
  EXPECT_THAT(materials_in_use(model.mesh), ElementsAre(-1, 1));
  const TriangleMesh none = part_of(model.mesh, -1), b = part_of(model.mesh, 1);
  EXPECT_EQ(none.positions, kOneTriangle);
  EXPECT_EQ(none.uvs, (std::vector<std::array<double, 2>>{{0, 1}, {1, 1}, {0, 0}}));
  EXPECT_EQ(b.triangles.size(), 2);
  EXPECT_EQ(b.positions.size(), 6);
  EXPECT_TRUE(part_of(model.mesh, 0).triangles.empty());
}

TEST(Model, KeepsAttributesThatEveryPrimitiveOfPartHas) {
  const MeshModel model = three_parts(R"(,"materials":[{},{}])");
  EXPECT_TRUE(part_of(model.mesh, 1).normals.empty());
  EXPECT_TRUE(part_of(model.mesh, 1).uvs.empty());
  EXPECT_TRUE(part_of(model.mesh, 1).colors.empty());
  EXPECT_EQ(part_of(model.mesh, -1).uvs.size(), 3);
  EXPECT_TRUE(whole_of(model.mesh).uvs.empty());
  EXPECT_EQ(whole_of(model.mesh).positions.size(), 9);
  ASSERT_EQ(model.mesh.colors.size(), 9);
  EXPECT_EQ(model.mesh.colors[1], Vec3d(0, 1, 0));
}

TEST(Model, ReadsMaterialsOfGltf) {
  const MeshModel model = three_parts(R"(,"materials":[{},{"name":"paint","pbrMetallicRoughness":
{"baseColorFactor":[0.5,0.25,1,0.75],"metallicFactor":0.5,"roughnessFactor":0.25},"emissiveFactor":[1,0.5,0],
"alphaMode":"MASK","alphaCutoff":0.125,"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},
"KHR_materials_unlit":{}}}])");
  ASSERT_EQ(model.materials.size(), 2);
  const ModelMaterial &plain = model.materials[0], &paint = model.materials[1];
  EXPECT_EQ(plain.base_color.factor, Vec3d(1));
  EXPECT_EQ(plain.metallic.factor, 1);
  EXPECT_EQ(plain.roughness.factor, 1);
  EXPECT_EQ(plain.alpha, ModelMaterial::Alpha::opaque);
  EXPECT_EQ(paint.name, "paint");
  EXPECT_EQ(paint.base_color.factor, Vec3d(0.5, 0.25, 1));
  EXPECT_EQ(paint.opacity, 0.75);
  EXPECT_EQ(paint.metallic.factor, 0.5);
  EXPECT_EQ(paint.roughness.factor, 0.25);
  EXPECT_EQ(paint.emission.factor, Vec3d(4, 2, 0));
  EXPECT_EQ(paint.alpha, ModelMaterial::Alpha::mask);
  EXPECT_EQ(paint.cutoff, 0.125);
  EXPECT_TRUE(paint.unlit);
}

TEST(Model, ReducesEmissionToLimit) {
  const auto emission = [](const char* strength) {
    return three_parts(R"(,"materials":[{},{"emissiveFactor":[1,0.5,0],"extensions":{)"
                       R"("KHR_materials_emissive_strength":{"emissiveStrength":)" +
                       std::string(strength) + "}}}]");
  };
  EXPECT_EQ(emission("1e6").materials[1].emission.factor, Vec3d(1e6, 5e5, 0));
  EXPECT_TRUE(emission("1e6").mesh.notes.empty());
  EXPECT_EQ(emission("3e7").materials[1].emission.factor, Vec3d(1e6, 5e5, 0));
  EXPECT_THAT(emission("3e7").mesh.notes,
              ElementsAre("1 materials emit more than 1e+06, which is the limit"));
}

constexpr const char* kTextured = R"(,"materials":[{},{"pbrMetallicRoughness":{"baseColorTexture":{"index":1,
"extensions":{"KHR_texture_transform":{"offset":[0.25,0.5],"scale":[2,4]}}},"metallicRoughnessTexture":{"index":0}}}],
"textures":[{"source":0},{"source":1,"sampler":0}],"samplers":[{"wrapS":33071,"wrapT":33071}],
"images":[{"uri":"a.png"},{"uri":"data:image/png;base64,QUJD"}])";

// A texture transform maps (u, v) of glTF to (2 u + 0.25, 4 v + 0.5). Here, v is 1 - v.
TEST(Model, ReadsTexturesAndImagesOfGltf) {
  const MeshModel model = three_parts(kTextured, [](const std::string& name) { return "bytes of " + name; });
  const ModelMaterial& material = model.materials[1];
  ASSERT_TRUE(material.base_color.texture && material.metallic.texture && material.roughness.texture);
  EXPECT_EQ(*model.images[static_cast<std::size_t>(material.base_color.texture->image)].bytes, "ABC");
  EXPECT_EQ(*model.images[static_cast<std::size_t>(material.metallic.texture->image)].bytes,
            "bytes of a.png");
  EXPECT_EQ(material.base_color.texture->wrap, ModelTexture::Wrap::clamp);
  EXPECT_EQ(material.base_color.texture->repeat, (std::array<double, 2>{2, 4}));
  EXPECT_EQ(material.base_color.texture->shift, (std::array<double, 2>{0.25, 1 - 4 - 0.5}));
  EXPECT_EQ(material.metallic.texture->wrap, ModelTexture::Wrap::repeat);
}

// Views of a buffer may be shared, and each image of a model is a copy.
TEST(Model, ReadsImagesWithTheSameBytesOnce) {
  const MeshModel model = three_parts(
      R"(,"materials":[{},{"pbrMetallicRoughness":{"baseColorTexture":{"index":1},)"
      R"("metallicRoughnessTexture":{"index":0}},"emissiveTexture":{"index":2},"emissiveFactor":[1,1,1]}],)"
      R"("textures":[{"source":0},{"source":1},{"source":2}],)"
      R"("images":[{"uri":"a.png"},{"uri":"a.png"},{"uri":"b.png"}])",
      [](const std::string& name) { return "bytes of " + name; });
  ASSERT_EQ(model.images.size(), 2);
  const ModelMaterial& material = model.materials[1];
  EXPECT_EQ(material.base_color.texture->image, material.metallic.texture->image);
  EXPECT_NE(material.base_color.texture->image, material.emission.texture->image);
}

TEST(Model, NotesMissingImages) {
  const MeshModel model = three_parts(kTextured);
  EXPECT_EQ(model.images.size(), 1);
  EXPECT_FALSE(model.materials[1].metallic.texture.has_value());
  ASSERT_EQ(model.mesh.notes.size(), 1);
  EXPECT_THAT(model.mesh.notes[0], HasSubstr("an image is missing: /images/0/uri"));
}

// Three primitives: two list the variants 0 and 2, and 1. The last lists none.
TEST(Model, ReadsVariantsOfMaterials) {
  Gltf gltf;
  gltf.positions(kOneTriangle);
  const std::string glb = gltf.glb(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"material":0,"extensions":{"KHR_materials_variants":{"mappings":[
{"material":1,"variants":[0,2]},{"material":2,"variants":[1]}]}}},
{"attributes":{"POSITION":0},"extensions":{"KHR_materials_variants":{"mappings":[{"material":3,"variants":[1]}]}}},
{"attributes":{"POSITION":0},"material":0}]}],"materials":[{},{},{},{}],
"extensionsUsed":["KHR_materials_variants"],"extensionsRequired":["KHR_materials_variants"],
"extensions":{"KHR_materials_variants":{"variants":[{"name":"day"},{"name":"dusk"},{"name":"night"}]}})");
  const auto materials = [&](const char* variant) {
    std::vector<int> numbers;
    for (const MeshPart& part : read_model(glb, {}, {}, {.variant = variant}).mesh.parts)
      numbers.push_back(part.material);
    return numbers;
  };
  EXPECT_THAT(materials(""), ElementsAre(0, -1, 0));
  EXPECT_THAT(materials("day"), ElementsAre(1, -1, 0));
  EXPECT_THAT(materials("dusk"), ElementsAre(2, 3, 0));
  EXPECT_THAT(materials("night"), ElementsAre(1, -1, 0));
  EXPECT_THAT(read_model(glb).variants, ElementsAre("day", "dusk", "night"));
  EXPECT_TRUE(read_model(glb).mesh.notes.empty());
  EXPECT_THAT(error_of([&] { materials("noon"); }),
              HasSubstr("variant must be one of the file, which has day, dusk, night (got \"noon\")"));
  EXPECT_THAT(error_of([] { read_model("v 0 0 0", {}, {}, {.variant = "day"}); }),
              HasSubstr("must be a glTF file to have a pose at a time or a variant (got obj)"));
}

TEST(Model, RejectsMaterialsThatDoNotExist) {
  EXPECT_THROW(three_parts(R"(,"materials":[{}])"), InputError);
  EXPECT_THROW(three_parts(""), InputError);
}

}  // namespace
}  // namespace orrery::test
