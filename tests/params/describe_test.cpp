#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/params/params.h"
#include "core/params/suggest.h"

namespace orrery {
namespace {

using nlohmann::json;

json schema_of(const Params::Read& read) { return json::parse(describe("id", "title", "description", read)); }

TEST(Describe, WritesRangesDefaultsAndDescriptions) {
  const json schema = schema_of([](Params& p) {
    p.number("fov", "Angle.", {.min = 0, .max = 180, .exclusive_min = true, .exclusive_max = true}, 45);
    p.integer("width", "Pixels.", 1, 4096, 600);
    p.choice("shading", "Which.", {"phong", "blinn-phong"}, "phong");
    p.integer("version", "Format.", 1, 1);
    p.text("title", "Name.", 200, "");
    p.numbers3("attenuation", "c0, c1, c2.", {.min = 0}, Vec3d{1, 0, 0});
    constexpr std::string_view kLayers[] = {"depth", "normal"};
    p.choice("first", "One.", kLayers, derived<std::string_view>("normal"));
    p.choices("layers", "Some.", kLayers);
  });
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], json::array({"version"}));
  const json& properties = schema["properties"];
  EXPECT_EQ(properties["fov"],
            json::parse(R"({"description": "Angle.", "type": "number", "exclusiveMinimum": 0,
                                               "exclusiveMaximum": 180, "default": 45})"));
  EXPECT_EQ(properties["width"], json::parse(R"({"description": "Pixels.", "type": "integer", "minimum": 1,
                                                 "maximum": 4096, "default": 600})"));
  EXPECT_EQ(properties["shading"], json::parse(R"({"description": "Which.", "enum": ["phong", "blinn-phong"],
                                                   "default": "phong"})"));
  EXPECT_EQ(properties["version"], json::parse(R"({"description": "Format.", "const": 1})"));
  EXPECT_EQ(properties["title"]["maxLength"], 200);
  EXPECT_EQ(properties["first"], json::parse(R"({"description": "One.", "enum": ["depth", "normal"]})"));
  EXPECT_EQ(properties["layers"],
            json::parse(R"({"description": "Some.", "type": "array", "uniqueItems": true, "maxItems": 2,
                            "items": {"enum": ["depth", "normal"]}})"));
  EXPECT_EQ(properties["attenuation"]["default"], json::array({1, 0, 0}));
}

TEST(Describe, SharesDefinitionsOfPointsAndColours) {
  const json schema = schema_of([](Params& p) {
    p.point("eye", "Where.");
    p.direction("up", "Up.", Vec3d{0, 1, 0});
    p.coefficient("kd", "Diffuse.", Vec3d{0.5, 0.5, 0.5});
    p.coefficient("ka", "Ambient; as kd if not given.", derived(Vec3d{0.5, 0.5, 0.5}));
    p.color("filter", "Filter.", Vec3d{1, 1, 1}, 1);
  });
  EXPECT_EQ(schema["properties"]["eye"],
            json::parse(R"({"description": "Where.", "$ref": "#/$defs/point"})"));
  EXPECT_EQ(schema["$defs"]["direction"]["not"], json::parse(R"({"const": [0, 0, 0]})"));
  EXPECT_EQ(schema["properties"]["kd"]["default"], json::array({0.5, 0.5, 0.5}));
  EXPECT_FALSE(schema["properties"]["ka"].contains("default"));
  EXPECT_EQ(schema["properties"]["filter"]["items"]["maximum"], 1);
  EXPECT_EQ(schema["required"], json::array({"eye"}));
}

TEST(Describe, DescribesEveryTypeAndForm) {
  constexpr Choice kTypes[] = {{"sphere", "A ball."}, {"cylinder", "A column."}};
  const json schema = schema_of([&](Params& p) {
    p.each("objects", "Things.", {.min = 1, .max = 9}, [&](Params& object) {
      if (object.pick("type", "Kind.", kTypes) == 0u) {
        object.positive("radius", "");
      } else {
        const bool infinite = object.form({{"base", "top"}, {"point", "axis"}}) == 1;
        object.point(infinite ? "point" : "base", "");
        infinite ? object.direction("axis", "") : object.point("top", "");
      }
      object.reference("material", "Name.", Names("material"));
    });
  });
  const json& objects = schema["properties"]["objects"];
  EXPECT_EQ(objects["minItems"], 1);
  const json& ways = objects["items"]["oneOf"];
  ASSERT_EQ(ways.size(), 3u);
  EXPECT_EQ(ways[0]["title"], "sphere");
  EXPECT_EQ(ways[0]["description"], "A ball.");
  EXPECT_EQ(ways[0]["required"], json::array({"type", "radius", "material"}));
  EXPECT_EQ(ways[1]["required"], json::array({"type", "base", "top", "material"}));
  EXPECT_EQ(ways[2]["required"], json::array({"type", "point", "axis", "material"}));
  for (const json& way : ways) EXPECT_EQ(way["additionalProperties"], false);
  EXPECT_EQ(ways[2]["properties"]["type"]["const"], "cylinder");
}

TEST(Describe, DescribesMapsListsAndOptionalObjects) {
  const json schema = schema_of([](Params& p) {
    p.each_named("materials", "", {.min = 1}, [](const std::string&, Params& m) { m.number("kd", ""); });
    p.each("lights", "", {.max = 1024}, [](Params& light) { light.flag("on", "", true); });
    p.optional_object("image", "", [](Params& image) { image.integer("width", "", 1, 9, 6); });
    p.points("positions", "", {.min = 3});
    p.directions("normals", "", {});
    p.index_triples("indices", "", {.min = 1}, 3);
    p.any("scene", "Anything.");
  });
  const json& properties = schema["properties"];
  EXPECT_EQ(properties["materials"]["additionalProperties"]["required"], json::array({"kd"}));
  EXPECT_EQ(properties["materials"]["minProperties"], 1);
  EXPECT_EQ(properties["lights"]["default"], json::array());
  EXPECT_EQ(properties["lights"]["maxItems"], 1024);
  EXPECT_EQ(properties["image"]["default"], json::object());
  EXPECT_EQ(properties["indices"]["items"]["items"]["type"], "integer");
  EXPECT_EQ(schema["required"], json::array({"materials", "positions", "indices"}));
}

TEST(Describe, SkipsSemanticChecks) {
  EXPECT_NO_THROW(schema_of([](Params& p) {
    if (p.point("eye", "") == p.point("look_at", "")) p.fail("eye", "equals look_at");
  }));
}

TEST(EditDistance, CountsEditsAndTranspositions) {
  EXPECT_EQ(edit_distance("radius", "radius", 2), 0);
  EXPECT_EQ(edit_distance("raduis", "radius", 2), 1);
  EXPECT_EQ(edit_distance("radis", "radius", 2), 1);
  EXPECT_EQ(edit_distance("rradiuss", "radius", 2), 2);
  EXPECT_EQ(edit_distance("", "ab", 2), 2);
  EXPECT_EQ(edit_distance("kitten", "sitting", 9), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting", 2), 3);
}

// Returns the edit distance, computed with the full dynamic-programming table.
int slow_edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = static_cast<int>(i + j);
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

TEST(EditDistance, MatchesFullTable) {
  std::uint32_t state = 1;
  const auto next = [&](std::uint32_t below) {
    return (state = state * 1664525 + 1013904223) / 65536 % below;
  };
  const auto word = [&] {
    std::string text(next(9), 'a');
    for (char& c : text) c = static_cast<char>('a' + next(3));
    return text;
  };
  for (int i = 0; i < 20'000; ++i) {
    const std::string a = word(), b = word();
    const int limit = static_cast<int>(next(5));
    ASSERT_EQ(edit_distance(a, b, limit), std::min(slow_edit_distance(a, b), limit + 1))
        << a << " " << b << " " << limit;
  }
}

TEST(Suggestion, FindsTyposCaseAndAbbreviations) {
  const std::string_view keys[] = {"eye", "look_at", "up", "fov_degrees", "center", "radius"};
  EXPECT_EQ(nearest("lookAt", keys), "look_at");
  EXPECT_EQ(nearest("Radius", keys), "radius");
  EXPECT_EQ(nearest("centre", keys), "center");
  EXPECT_EQ(nearest("fov", keys), "fov_degrees");
  EXPECT_EQ(nearest("radius_metres", keys), "radius");
  EXPECT_EQ(nearest("r", keys), "radius");
  EXPECT_EQ(nearest("rad", keys), "radius");
  EXPECT_EQ(nearest("", keys), std::nullopt);
  EXPECT_EQ(nearest("", std::vector<std::string_view>{"one"}), std::nullopt);
  EXPECT_EQ(nearest("e", std::vector<std::string_view>{"eye", "edge"}), std::nullopt)
      << "ambiguous abbreviation";
  EXPECT_EQ(nearest("to", keys), std::nullopt);
  EXPECT_EQ(nearest("colour", keys), std::nullopt);
  EXPECT_EQ(nearest(std::string(1 << 20, 'x'), keys), std::nullopt);
  std::vector<std::string> names;  // the cost of a search must be limited
  for (int i = 0; i < 200'000; ++i) names.push_back(std::string(60, 'a') + std::to_string(i % 10));
  EXPECT_EQ(nearest(std::string(62, 'b'), std::vector<std::string_view>(names.begin(), names.end())),
            std::nullopt);
  EXPECT_EQ(did_you_mean("uup", keys), " (did you mean \"up\"?)");
}

TEST(Suggestion, FindsSynonymousKeys) {
  const auto key_for = [](std::string_view word, std::vector<std::string_view> keys) {
    return nearest_key(word, keys).value_or("none");
  };
  const std::vector<std::string_view> rough = {"kd", "ka", "ks", "shininess", "shading", "emission"},
                                      camera = {"eye", "look_at", "up", "fov_degrees"},
                                      mesh = {"material", "positions", "indices", "normals", "file"};
  for (const char* word :
       {"diffuse", "color", "colour", "albedo", "diffuse_color", "diffuseColor", "Albedo"}) {
    EXPECT_EQ(key_for(word, rough), "kd") << word;
    EXPECT_EQ(key_for(word, {"reflectance", "emission"}), "reflectance") << word;
  }
  EXPECT_EQ(key_for("specular", rough), "ks");
  EXPECT_EQ(key_for("ambient_color", rough), "ka");
  for (const char* word : {"emissive", "emit", "emitted"})
    EXPECT_EQ(key_for(word, rough), "emission") << word;
  for (const char* word : {"position", "pos", "origin", "location", "from"})
    EXPECT_EQ(key_for(word, camera), "eye") << word;
  for (const char* word : {"position", "pos", "origin", "location"})
    EXPECT_EQ(key_for(word, {"center", "radius"}), "center") << word;
  for (const char* word : {"target", "lookat", "look", "LookAt"})
    EXPECT_EQ(key_for(word, camera), "look_at") << word;
  for (const char* word : {"fov", "angle"}) EXPECT_EQ(key_for(word, camera), "fov_degrees") << word;
  EXPECT_EQ(key_for("spp", {"samples", "seed"}), "samples");
  for (const char* word : {"bounces", "depth"})
    EXPECT_EQ(key_for(word, {"technique", "max_depth"}), "max_depth") << word;
  EXPECT_EQ(key_for("transform", {"model", "scale", "rotate", "translate"}), "translate");
  EXPECT_EQ(key_for("size", {"width", "height"}), "width");
  for (const char* word : {"eta", "index"}) EXPECT_EQ(key_for(word, {"ior", "filter"}), "ior") << word;
  for (const char* word : {"vertices", "points"}) EXPECT_EQ(key_for(word, mesh), "positions") << word;
  EXPECT_EQ(key_for("faces", mesh), "indices");
  EXPECT_EQ(key_for("raduis", {"center", "radius"}), "radius") << "spelling";
}

TEST(Suggestion, SuggestsOnlyUnusedSynonyms) {
  const std::vector<std::string_view> with_vertices = {"material", "vertices"}, plane = {"point", "normal"};
  EXPECT_EQ(nearest_key("points", with_vertices), "vertices");
  EXPECT_EQ(nearest_key("points", plane), "point") << "spelling";
  EXPECT_EQ(nearest_key("color", plane), std::nullopt);
  EXPECT_EQ(nearest_key("", plane), std::nullopt);
  EXPECT_EQ(nearest_key(std::string(1 << 20, 'x'), plane), std::nullopt);
  EXPECT_EQ(did_you_mean_key("position", plane), " (did you mean \"point\"?)");
  EXPECT_EQ(did_you_mean_key("color", plane), "");
}

}  // namespace
}  // namespace orrery
