#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "core/base/error.h"
#include "core/params/params.h"

namespace orrery {
namespace {

void read_text(std::string_view text, const Params::Read& read) { read_document(parse_document(text), read); }

// Returns one line "pointer: detail" for each problem.
std::vector<std::string> problems(std::string_view text, const Params::Read& read) {
  std::vector<std::string> lines;
  try {
    read_text(text, read);
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) lines.push_back(p.pointer + ": " + p.detail);
  }
  return lines;
}

using Lines = std::vector<std::string>;

void read_sphere(Params& p) {
  p.point("center", "");
  p.positive("radius", "");
}

TEST(Reader, ShortensLongNames) {
  const std::string name(8'000'000, '~');
  const auto lines =
      problems(R"({"materials": {")" + name + R"(": {}}, ")" + name + R"(": 1})", [](Params& p) {
        p.each_named("materials", "", {}, [](const std::string&, Params& m) { m.positive("shininess", ""); });
      });
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].starts_with("/materials/~0~0~0")) << lines[0];
  EXPECT_NE(lines[0].find("~0... (8000000 characters): must be a name of 1 to 128 characters"),
            std::string::npos)
      << lines[0];
  EXPECT_LT(lines[0].size(), 400u);
  EXPECT_LT(lines[1].size(), 400u);
}

TEST(Reader, ReportsPathLimitAndValue) {
  const auto read = [](Params& p) { p.each("objects", "", {}, read_sphere); };
  EXPECT_EQ(
      problems(R"({"objects": [{"center": [0,0,0], "radius": 1}, {"center": [0,0,0], "radius": "big"}]})",
               read),
      Lines{R"(/objects/1/radius: must be a number from 1e-12 to 1e12 (got "big"))"});
  EXPECT_EQ(problems(R"({"objects": [{"center": [0,0,0], "radius": -1}]})", read),
            Lines{"/objects/0/radius: must be a number from 1e-12 to 1e12 (got -1)"});
  EXPECT_EQ(problems(R"({"objects": [{"center": [0,"x",1e13], "radius": 1}]})", read),
            (Lines{R"(/objects/0/center/1: must be a number from -1e12 to 1e12 (got "x"))",
                   "/objects/0/center/2: must be a number from -1e12 to 1e12 (got 10000000000000)"}));
  EXPECT_EQ(problems(R"({"objects": [{"center": [0,0], "radius": 1}]})", read),
            Lines{"/objects/0/center: must be 3 numbers from -1e12 to 1e12 (got [0,0])"});
  EXPECT_EQ(problems(R"({"objects": [7]})", read), Lines{"/objects/0: must be an object (got 7)"});
  EXPECT_EQ(problems("[1]", read), Lines{": must be an object (got [1])"});
}

TEST(Reader, SuggestsNearestKey) {
  EXPECT_EQ(problems(R"({"center": [0,0,0], "raduis": 1})", read_sphere),
            (Lines{R"(: missing key "radius" (must be a number from 1e-12 to 1e12))",
                   R"(: unknown key "raduis" (did you mean "radius"?))"}));
  EXPECT_EQ(problems(R"({"center": [0,0,0], "radius": 1, "colour": 1})", read_sphere),
            Lines{R"(: unknown key "colour")"});
}

TEST(Reader, SuggestsUnusedSynonymousKey) {
  EXPECT_EQ(problems(R"({"position": [0,0,0], "radius": 1})", read_sphere),
            (Lines{R"(: missing key "center" (must be 3 numbers from -1e12 to 1e12))",
                   R"(: unknown key "position" (did you mean "center"?))"}));
  EXPECT_EQ(problems(R"({"center": [0,0,0], "position": [0,0,0], "radius": 1})", read_sphere),
            Lines{R"(: unknown key "position")"});
}

TEST(Reader, TruncatesLongValues) {
  const std::string text = R"({"radius": ")" + std::string(100000, 'a') + R"(", "center": [0,0,0]})";
  EXPECT_EQ(problems(text, read_sphere),
            Lines{"/radius: must be a number from 1e-12 to 1e12 (got \"" + std::string(39, 'a') + "...)"});
}

TEST(Reader, EscapesPointersAndNames) {
  const auto read = [](Params& p) {
    p.each_named("materials", "", {}, [](const std::string&, Params& m) { m.number("kd", "", {.min = 0}); });
  };
  EXPECT_EQ(
      problems(R"({"materials": {"a/b~c": {"kd": -1}, "\"": {"kd": 1, "\n": 2}, "": {"kd": 1}}})", read),
      (Lines{R"(/materials/: must be a name of 1 to 128 characters (got ""))",
             R"(/materials/": unknown key "\n")",
             "/materials/a~1b~0c/kd: must be a number of at least 0 (got -1)"}));
}

TEST(Reader, ReadsValuesAndDefaults) {
  bool ran = false;
  read_text(
      R"({"n": 2.5, "i": 3.0, "f": true, "c": "b", "t": "é", "v": [1, -0.0, 3], "k": 0.5, "kc": [1,2,3]})",
      [&](Params& p) {
        EXPECT_EQ(p.number("n", ""), 2.5);
        EXPECT_EQ(p.number("n2", "", {}, 7), 7);
        EXPECT_EQ(p.integer("i", "", 0, 5), 3);
        EXPECT_EQ(p.integer("i2", "", 0, 5, 4), 4);
        EXPECT_TRUE(p.flag("f", ""));
        EXPECT_FALSE(p.flag("f2", "", false));
        EXPECT_EQ(p.choice("c", "", {"a", "b"}), "b");
        EXPECT_EQ(p.choice("c2", "", {"a", "b"}, "a"), "a");
        EXPECT_EQ(p.text("t", "", 1), "é");
        EXPECT_EQ(p.text("t2", "", 1, ""), "");
        EXPECT_EQ(p.point("v", ""), (Vec3d{1, 0, 3}));
        EXPECT_EQ(p.color("v2", "", Vec3d{1, 1, 1}), (Vec3d{1, 1, 1}));
        EXPECT_EQ(p.coefficient("k", ""), (Vec3d{0.5, 0.5, 0.5}));
        EXPECT_EQ(p.coefficient("kc", ""), (Vec3d{1, 2, 3}));
        EXPECT_EQ(p.coefficient("kd", "", derived(Vec3d{4, 4, 4})), (Vec3d{4, 4, 4}));
        EXPECT_EQ(p.numbers3("a", "", {.min = 0}, Vec3d{1, 0, 0}), (std::array<double, 3>{1, 0, 0}));
        EXPECT_TRUE(p.has("n"));
        EXPECT_FALSE(p.has("n2"));
        ran = true;
      });
  EXPECT_TRUE(ran);
}

TEST(Reader, ReadsNegativeZeroAsZero) {
  read_text(R"({"v": [-0.0, -0, 0], "n": -0.0})", [](Params& p) {
    const Vec3d v = p.point("v", "");
    EXPECT_FALSE(std::signbit(v.x) || std::signbit(v.y) || std::signbit(v.z) ||
                 std::signbit(p.number("n", "")));
  });
}

TEST(Reader, ReadsListsOfWords) {
  constexpr std::string_view kColours[] = {"red", "green", "blue"};
  const auto read = [&](Params& p) { return p.choices("c", "", kColours); };
  std::vector<std::string> words;
  const auto words_of = [&](const char* text) {
    read_text(text, [&](Params& p) { words = read(p); });
    return words;
  };
  EXPECT_EQ(words_of(R"({"c": ["blue", "red"]})"), (Lines{"blue", "red"}));
  EXPECT_EQ(words_of(R"({"c": []})"), Lines());
  EXPECT_EQ(words_of("{}"), Lines());
  EXPECT_EQ(problems(R"({"c": ["red", "gren", 3, "red"]})", read),
            (Lines{"/c: must be a list of at most 3 different words (got 4 entries)"}));
  EXPECT_EQ(problems(R"({"c": ["red", "gren", "red"]})", read),
            (Lines{R"(/c/1: must be one of "red", "green" or "blue" (got "gren"; did you mean "green"?))",
                   R"(/c/2: must not repeat an earlier word (got "red"))"}));
  EXPECT_EQ(problems(R"({"c": "red"})", read),
            (Lines{R"(/c: must be a list of at most 3 different words (got "red"))"}));
}

TEST(Reader, ReportsAllowedScalarValues) {
  EXPECT_EQ(
      problems(R"({"n": 180, "i": 2.5, "j": 1e300, "v": 2, "f": 1, "c": "blin-phong", "d": 4, "t": "abc"})",
               [](Params& p) {
                 p.number("n", "", {.min = 0, .max = 180, .exclusive_min = true, .exclusive_max = true});
                 p.integer("i", "", 1, 4096);
                 p.integer("j", "", 0, 9007199254740992);
                 p.integer("v", "", 1, 1);
                 p.flag("f", "");
                 p.choice("c", "", {"phong", "blinn-phong"});
                 p.choice("d", "", {"phong", "blinn-phong"});
                 p.text("t", "", 2);
               }),
      (Lines{"/n: must be a number > 0 and < 180 (got 180)",
             "/i: must be an integer from 1 to 4096 (got 2.5)",
             "/j: must be an integer from 0 to 9007199254740992 (got 1e+300)", "/v: must be 1 (got 2)",
             "/f: must be true or false (got 1)",
             R"(/c: must be "phong" or "blinn-phong" (got "blin-phong"; did you mean "blinn-phong"?))",
             R"(/d: must be "phong" or "blinn-phong" (got 4))",
             R"(/t: must be a string of at most 2 characters (got "abc"))"}));
}

TEST(Reader, NormalizesDirections) {
  for (const char* text :
       {R"({"d": [3e-300, 0, 4e-300]})", R"({"d": [3e11, 0, 4e11]})", R"({"d": [3, 0, 4]})"}) {
    read_text(text, [&](Params& p) {
      const Vec3d d = p.direction("d", "");
      EXPECT_NEAR(d.x, 0.6, 1e-15) << text;
      EXPECT_NEAR(d.z, 0.8, 1e-15) << text;
    });
  }
  EXPECT_EQ(problems(R"({"d": [0, 0.0, -0]})", [](Params& p) { p.direction("d", ""); }),
            Lines{"/d: must be 3 numbers from -1e12 to 1e12, not all 0 (got [0,0,0])"});
}

TEST(Reader, ReadsCoefficientsAsNumberOrColour) {
  const auto read = [](Params& p) { p.coefficient("k", "", Vec3d{0, 0, 0}); };
  EXPECT_EQ(problems(R"({"k": -1})", read),
            Lines{"/k: must be a number or 3 numbers from 0 to 1e6 (got -1)"});
  EXPECT_EQ(problems(R"({"k": [1]})", read),
            Lines{"/k: must be a number or 3 numbers from 0 to 1e6 (got [1])"});
  EXPECT_EQ(problems(R"({"k": [1,1,-1]})", read), Lines{"/k/2: must be a number from 0 to 1e6 (got -1)"});
}

TEST(Reader, ChecksSizeAndElementsOfLists) {
  const auto read = [](Params& p) {
    EXPECT_GE(p.points("positions", "", {.min = 3}).size(), 3u);  // even after an error
    p.index_triples("indices", "", {.min = 1, .max = 2}, 3);
    p.directions("normals", "", {});
  };
  EXPECT_EQ(
      problems(R"({"positions": [[0,0,0],[1,0,0],[0,1,0]], "indices": [[0,1,2]], "normals": [[0,0,2]]})",
               read),
      Lines{});
  EXPECT_EQ(problems(R"({"positions": [[0,0,0]], "indices": [[0,1,3],[0,-1,1.5]]})", read),
            (Lines{"/positions: must be a list of at least 3 points (got 1 entry)",
                   "/indices/0/2: must be an integer from 0 to 2 (got 3)",
                   "/indices/1/1: must be an integer from 0 to 2 (got -1)",
                   "/indices/1/2: must be an integer from 0 to 2 (got 1.5)"}));
  EXPECT_EQ(problems(R"({"positions": {}, "indices": [[0,1,2],[0,1],[0,1,2]], "normals": [[0,0,0]]})", read),
            (Lines{"/positions: must be a list of at least 3 points (got {})",
                   "/indices: must be a list of 1 to 2 triples of integers (got 3 entries)",
                   "/normals/0: must be 3 numbers from -1e12 to 1e12, not all 0 (got [0,0,0])"}));
  EXPECT_EQ(problems(R"({"positions": [[0,0,0],[1,0,0],[0,1]]})", read),
            (Lines{"/positions/2: must be 3 numbers from -1e12 to 1e12 (got [0,1])",
                   R"(: missing key "indices" (must be a list of 1 to 2 triples of integers))"}));
}

TEST(Reader, ReadsDefaultsOfOptionalObjects) {
  int width = 0;
  const auto read = [&](Params& p) {
    p.optional_object("image", "",
                      [&](Params& image) { width = static_cast<int>(image.integer("width", "", 1, 9, 6)); });
  };
  EXPECT_EQ(problems("{}", read), Lines{});
  EXPECT_EQ(width, 6);
  EXPECT_EQ(problems(R"({"image": null})", read), Lines{"/image: must be an object (got null)"});
  EXPECT_EQ(problems("{}", [](Params& p) { p.object("camera", "", [](Params&) { FAIL(); }); }),
            Lines{R"(: missing key "camera" (must be an object))"});
}

TEST(Reader, PicksTypeByName) {
  constexpr Choice kTypes[] = {{"sphere", "A ball."}, {"plane", "A floor."}};
  std::optional<std::size_t> type;
  const auto read = [&](Params& p) {
    type = p.pick("type", "", kTypes);
    if (type == 0u) p.text("name", "", 9);
  };
  EXPECT_EQ(problems(R"({"type": "sphere", "name": "x"})", read), Lines{});
  EXPECT_EQ(type, 0u);
  EXPECT_EQ(problems(R"({"type": "shpere", "leftover": 1})", read),
            Lines{R"(/type: must be "sphere" or "plane" (got "shpere"; did you mean "sphere"?))"});
  EXPECT_EQ(type, std::nullopt);
  EXPECT_EQ(problems(R"({"leftover": 1})", read),
            Lines{R"(: missing key "type" (must be "sphere" or "plane"))"});
  EXPECT_EQ(problems(R"({"type": "plane", "nom": 1})", read), Lines{R"(: unknown key "nom")"});
  EXPECT_EQ(type, 1u);
}

TEST(Reader, ChoosesFormByPresentKeys) {
  std::size_t form = 9;
  const auto read = [&](Params& p) {
    form = p.form({{"base", "top"}, {"point", "axis"}});
    p.number(form == 0 ? "base" : "point", "");
    p.number(form == 0 ? "top" : "axis", "");
  };
  EXPECT_EQ(problems(R"({"base": 1, "top": 2})", read), Lines{});
  EXPECT_EQ(form, 0u);
  EXPECT_EQ(problems(R"({"point": 1, "axis": 2})", read), Lines{});
  EXPECT_EQ(form, 1u);
  EXPECT_EQ(problems(R"({"axis": 2})", read), Lines{R"(: missing key "point" (must be a number))"});
  EXPECT_EQ(problems(R"({"base": 1, "axis": 2})", read),
            Lines{R"(: must have either "base" and "top", or "point" and "axis" (got "base", "axis"))"});
  EXPECT_EQ(problems("{}", read),
            Lines{R"(: must have either "base" and "top", or "point" and "axis" (got none of them))"});
}

TEST(Reader, RejectsUnknownReferences) {
  Names names("material");
  names.add("silver");
  names.add("plum");
  const auto read = [&](Params& p) {
    const std::size_t index = p.reference("material", "", names);
    EXPECT_EQ(index, static_cast<std::size_t>(p.integer("index", "", 0, 1, 0)));
  };
  EXPECT_EQ(problems(R"({"material": "plum", "index": 1})", read), Lines{});
  EXPECT_EQ(problems(R"({"material": "slver"})", read),
            Lines{R"(/material: unknown material "slver" (did you mean "silver"?))"});
  EXPECT_EQ(problems(R"({"material": 3})", read), Lines{"/material: must be the name of a material (got 3)"});
}

TEST(Reader, ChecksSemanticsOnlyOfValidValues) {
  const auto read = [](Params& p) {
    p.object("camera", "", [](Params& camera) {
      if (camera.point("eye", "") == camera.point("look_at", "")) camera.fail("look_at", "equals eye");
    });
    p.fail("", "never good");
  };
  EXPECT_EQ(problems(R"({"camera": {"eye": [0,0,0], "look_at": [0,0,0]}})", read),
            (Lines{"/camera/look_at: equals eye", ": never good"}));
  EXPECT_EQ(problems(R"({"camera": {"eye": [0,0,0], "look_at": "x"}})", read).size(), 1u);
}

TEST(Reader, ReportsFullPointerInsideAnyValue) {
  std::optional<Document> scene;
  read_text(R"({"scene": {"radius": "x", "center": [0,0,0]}})",
            [&](Params& p) { scene = p.any("scene", ""); });
  ASSERT_TRUE(scene);
  try {
    read_document(*scene, read_sphere);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().pointer, "/scene/radius");
  }
}

TEST(Reader, StopsAtTwentyProblems) {
  std::string text = R"({"objects": [0)";
  for (int i = 0; i < 100000; ++i) text += ",0";
  int visits = 0;
  EXPECT_EQ(
      problems(text + "]}", [&](Params& p) { p.each("objects", "", {}, [&](Params&) { ++visits; }); }).size(),
      20u);
  EXPECT_EQ(visits, 0);
}

TEST(Reader, ReadsMillionNodes) {
  std::string text = R"({"objects": [)";
  constexpr int kCount = 160'000;  // 6 nodes each
  for (int i = 0; i < kCount; ++i) text += R"({"center":[0.25,-1.5e3,7],"radius":0.125},)";
  text.back() = ']';
  text += "}";
  int read = 0;
  const auto start = std::chrono::steady_clock::now();
  read_text(text, [&](Params& p) {
    p.each("objects", "", {}, [&](Params& object) {
      read_sphere(object);
      ++read;
    });
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds.count()));
  EXPECT_EQ(read, kCount);
}

}  // namespace
}  // namespace orrery
