#include "core/load/load.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "core/lights/registry.h"
#include "core/materials/registry.h"
#include "core/shapes/registry.h"
#include "tests/support/covers.h"
#include "tests/support/scenes.h"

namespace orrery::test {
namespace {

std::string problem_of_object(const char* object) { return first_problem(scene_of(object)); }

// Replaces `what` by `by` in the text of a scene and returns the first problem of the scene. A JSON tree
// cannot represent some of these values.
std::string problem_of_text(const char* what, const char* by) {
  std::string text = scene_of("[{'type': 'sphere', 'center': [0.125, 0, 0], 'radius': 0.375}]").dump();
  text.replace(text.find(what), std::string_view(what).size(), by);
  return first_problem_in_text(text);
}

TEST(Load, RejectsNonPositiveRadii) {
  covers("A6");
  EXPECT_EQ(problem_of_object("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0}]"), "/objects/0/radius");
  EXPECT_EQ(problem_of_object("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': -1}]"),
            "/objects/0/radius");
  EXPECT_EQ(problem_of_object("[{'type': 'cylinder', 'base': [0, 0, 0], 'top': [0, 1, 0], 'radius': 0}]"),
            "/objects/0/radius");
  EXPECT_EQ(
      problem_of_object("[{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': -1e-9}]"),
      "/objects/0/radius");
  EXPECT_EQ(problem_of_object("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1e-12}]"), "accepted");
  EXPECT_NE(problem_of_text("0.375", "NaN"), "accepted");
}

TEST(Load, RejectsInvalidNumbersAndReportsTheirPath) {
  covers("A36");
  for (const char* bad :
       {"NaN", "Infinity", "-Infinity", "1e999", "1,5", "0x10", "1.", ".5", "+1", "null", "\"1\"", "true"})
    EXPECT_NE(problem_of_text("0.375", bad), "accepted") << bad;
  EXPECT_EQ(problem_of_text("0.375", "1e999"), "/objects/0/radius");
  EXPECT_EQ(problem_of_text("0.125", "1e13"), "/objects/0/center/0");
  EXPECT_EQ(problem_of_text("\"width\":64", "\"width\":65536"), "/image/width");
  EXPECT_EQ(problem_of_text("\"width\":64", "\"width\":0"), "/image/width");
  EXPECT_EQ(problem_of_object("[]"), "/objects");
  EXPECT_EQ(first_problem_in_text("{}"), "");
  EXPECT_NE(first_problem_in_text(""), "accepted");
}

// Reflectances and filters are between 0 and 1: no surface reflects a negative fraction, and no medium
// amplifies light.
TEST(Load, RejectsReflectancesOutsideUnitInterval) {
  const auto problem = [](const char* material) {
    Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
    scene["materials"]["it"] = json(material);
    return first_problem(scene);
  };
  for (const char* key : {"ka", "kd", "ks"}) {
    const std::string start = std::string("{'type': 'rough', '") + key + "': ";
    EXPECT_EQ(problem((start + "0}").c_str()), "accepted") << key;
    EXPECT_EQ(problem((start + "1}").c_str()), "accepted") << key;
    EXPECT_EQ(problem((start + "-0.5}").c_str()), std::string("/materials/it/") + key);
  }
  EXPECT_EQ(problem("{'type': 'refractive', 'ior': 1.5, 'filter': [0, 1, 0.5]}"), "accepted");
  EXPECT_EQ(problem("{'type': 'refractive', 'ior': 1.5, 'filter': [1, 1.001, 1]}"), "/materials/it/filter/1");
  EXPECT_EQ(problem("{'type': 'refractive', 'ior': 1.5, 'filter': [-0.001, 1, 1]}"),
            "/materials/it/filter/0");
}

TEST(Load, ListsEveryRegisteredTypeInSchema) {
  const std::string schema = scene_schema();
  const auto named = [&](const auto& types) {
    for (const auto& type : types)
      EXPECT_NE(schema.find("\"" + std::string(type.name) + "\""), std::string::npos) << type.name;
  };
  named(shape_types());
  named(material_types());
  named(light_types());
}

TEST(Load, AssignsMaterialToEachPrimitive) {
  const auto scene = load(scene_of(
      R"([{'type': 'box', 'min': [0, 0, 0], 'max': [1, 1, 1], 'material': 'glass'},
      {'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'b'},
      {'type': 'mesh', 'positions': [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], 'indices': [[0, 1, 2], [1, 3, 2]], 'material': 'a'},
      {'type': 'sphere', 'center': [3, 0, 0], 'radius': 1, 'material': 'silver'}])",
      R"({'materials': {'white': null, 'a': {'type': 'rough'}, 'b': {'type': 'rough'}, 'glass': {'type': 'refractive', 'ior': 1.5},
          'silver': {'type': 'reflective', 'n': [0, 0, 0], 'k': [0, 0, 0]}}})"));
  EXPECT_EQ(scene->object_count, 4);
  ASSERT_EQ(scene->primitive_count(), 5);
  std::vector<int> first(scene->materials.size() + 1, 0);  // number of the first material of each set
  for (std::size_t set = 0; set < scene->materials.size(); ++set)
    first[set + 1] = first[set] + scene->materials[set]->size();
  const auto set_of = [&](std::string_view type) {
    for (std::size_t i = 0; i < material_types().size(); ++i)
      if (material_types()[i].name == type) return first[i];
    return -1;
  };
  // Primitives are numbered by shape type: spheres before meshes, meshes before boxes.
  EXPECT_EQ(scene->material_of[0], set_of("rough") + 1);
  EXPECT_EQ(scene->material_of[1], set_of("reflective"));
  EXPECT_EQ(scene->material_of[2], set_of("rough"));
  EXPECT_EQ(scene->material_of[3], set_of("rough"));
  EXPECT_EQ(scene->material_of[4], set_of("refractive"));
}

TEST(Load, RequiresObjectOrInstance) {
  Json scene = scene_of(R"({'type': 'sphere', 'center': [0, 0, 0], 'radius': 1})");
  scene["models"]["it"]["objects"] = scene["objects"];
  scene["objects"] = Json::array();
  EXPECT_EQ(first_problem(scene), "/objects");
  scene.erase("objects");
  EXPECT_EQ(first_problem(scene), "/objects");
  scene["instances"] = json("[{'model': 'it'}, {'model': 'it', 'translate': [2, 0, 0]}]");
  EXPECT_EQ(first_problem(scene), "accepted");
  EXPECT_EQ(load(scene)->primitive_count(), 2);
}

TEST(Load, CollectsFactsForPlanning) {
  const auto scene = load(scene_of(R"([{'type': 'plane', 'point': [0, -1e6, 0], 'normal': [0, 1, 0]},
      {'type': 'sphere', 'center': [100, 0, 0], 'radius': 2}, {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.5}])"));
  EXPECT_EQ(scene->facts.magnitude.value, 1e6) << "includes the point of a plane";
  EXPECT_EQ(scene->facts.magnitude.where, "/objects/0");
  EXPECT_NEAR(scene->facts.smallest_feature.value, std::sqrt(3.0), 1e-15);
  EXPECT_EQ(scene->facts.smallest_feature.where, "/objects/2");
  EXPECT_EQ(scene->facts.bounds.hi, Vec3d(102, 2, 2));
  EXPECT_TRUE(scene->facts.materials.lit);
  EXPECT_FALSE(scene->facts.materials.mirrors);
}

TEST(Load, DerivesIdFromContentNotLayout) {
  const auto id = [](const char* text) { return load_scene(json(text).dump(2))->id; };
  const char* plain =
      "{'version': 1, 'camera': {'type': 'perspective', 'eye': [0, 0, 4], 'look_at': [0, 0, 0]},"
      " 'materials': {'m': {'type': 'rough'}}, 'objects': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': "
      "1, 'material': 'm'}]}";
  const char* spaced =
      "{'objects': [{'radius': 1.0, 'material': 'm', 'type': 'sphere', 'center': [0, 0, -0.0]}],"
      " 'materials': {'m': {'type': 'rough'}}, 'camera': {'look_at': [0, 0, 0], 'eye': [0, 0, 4e0], 'type': "
      "'perspective'}, 'version': 1}";
  EXPECT_EQ(id(plain), id(spaced));
  EXPECT_EQ(id(plain).size(), 64u);
}

TEST(Load, RejectsInvalidInstances) {
  covers("A38");
  const auto problem = [](const char* instance) {
    Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
    scene["models"]["it"]["objects"] = {
        {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "white"}}};
    scene["instances"] = Json::array({json(instance)});
    return first_problem(scene);
  };
  EXPECT_EQ(problem("{'model': 'it', 'scale': [1, -2, 0.5], 'translate': [1, 2, 3]}"), "accepted");
  EXPECT_EQ(problem("{'model': 'that'}"), "/instances/0/model");
  EXPECT_EQ(problem("{'model': 'it', 'scale': [1, 0, 1]}"), "/instances/0/scale");
  EXPECT_EQ(problem("{'model': 'it', 'scale': [1, 1e7, 1]}"), "/instances/0/scale/1");
  EXPECT_EQ(problem("{'model': 'it', 'rotate': {'axis': [0, 0, 0], 'degrees': 3}}"),
            "/instances/0/rotate/axis");
  EXPECT_EQ(problem("{'model': 'it', 'turn': 3}"), "/instances/0");
}

TEST(Load, RejectsInstancedPrimitivesAboveLimit) {
  Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
  Json& objects = scene["models"]["it"]["objects"];
  for (int i = 0; i < 1000; ++i)
    objects.push_back({{"type", "sphere"}, {"center", {i, 0, 0}}, {"radius", 1}, {"material", "white"}});
  for (int i = 0; i < 20'001; ++i) scene["instances"].push_back({{"model", "it"}});
  EXPECT_EQ(first_problem(scene), "/instances");
}

// A camera that looks along its up vector takes another one, with a note.
TEST(Load, ReplacesUpAlongTheView) {
  const auto loaded = [](const char* eye, const char* up) {
    return load_scene(
        std::string(
            "{\"version\": 1, \"camera\": {\"type\": \"perspective\", \"look_at\": [0, 0, 0], \"eye\": ") +
        eye + ", \"up\": " + up +
        "}, \"materials\": {\"m\": {\"type\": \"lambert\"}}, \"objects\": [{\"type\": \"sphere\", "
        "\"center\": [0, 0, 0], \"radius\": 1, \"material\": \"m\"}]}");
  };
  const auto above = loaded("[0, 5, 0]", "[0, 1, 0]");
  EXPECT_EQ(above->placement.up, Vec3d(0, 0, -1));
  ASSERT_EQ(above->notes.size(), 1);
  EXPECT_EQ(above->notes[0].text(),
            "/camera/up: is parallel to the view direction and was replaced by [0, 0, -1]");
  EXPECT_EQ(loaded("[0, 0, 5]", "[0, 0, 2]")->placement.up, Vec3d(0, 1, 0));
  EXPECT_EQ(loaded("[5, 0, 1]", "[5, 0, 1]")->placement.up, Vec3d(0, 1, 0));
  EXPECT_TRUE(loaded("[0, 5, 1]", "[0, 1, 0]")->notes.empty());
}

}  // namespace
}  // namespace orrery::test
