#include "core/plan/options.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "core/load/load.h"
#include "core/params/json.h"
#include "core/plan/limits.h"
#include "core/techniques/registry.h"
#include "tests/support/pictures.h"

// Tests the table of render options, row by row.
namespace orrery::test {
namespace {

RenderSettings read(const Json& request) { return read_request(document_of(request)); }

// Returns the problem of the value with its pointer, as "/render/samples: must be ...", or "" if the value
// is valid.
std::string problem(const RenderOption& option, const Json& value) {
  try {
    read({{name_of(option.section), {{option.key, value}}}});
  } catch (const InputError& error) {
    return error.problems().front().pointer + ": " + error.problems().front().detail;
  }
  return "";
}

Json value_of(const RenderOption& option, const RenderSettings& settings) {
  return Json::parse(option.text(settings));
}

struct ExtremeValues {
  template <class I>
  std::vector<Json> operator()(const RenderOption::Integer<I>& kind) const {
    return {kind.min, kind.max};
  }
  std::vector<Json> operator()(const RenderOption::Number& kind) const {
    const auto& [min, max, no_min, no_max] = kind.range;
    return {no_min ? std::nextafter(min, max) : min, no_max ? std::nextafter(max, min) : max};
  }
  std::vector<Json> operator()(const RenderOption::Flag&) const { return {false, true}; }
  std::vector<Json> operator()(const RenderOption::Point&) const {
    return {Json{-kMaxCoordinate, 0.1, 1e-300}, Json{kMaxCoordinate, 1.0 / 3, -1e-7}};
  }
  std::vector<Json> operator()(const RenderOption::NameList& kind) const {
    return {Json::array(), Json(kind.names())};
  }
  std::vector<Json> operator()(const auto&) const { return {}; }
};
// Returns the minimum and maximum of an option, or all its choices.
std::vector<Json> extreme_values(const RenderOption& option) {
  std::vector<Json> values = std::visit(ExtremeValues(), option.kind);
  if (option.form() == RenderOption::Form::string)
    for (const std::string_view choice : option.choices()) values.push_back(choice);
  return values;
}

struct InvalidValues {
  template <class I>
  std::vector<Json> operator()(const RenderOption::Integer<I>& kind) const {
    return {kind.min - 1, kind.max + 1, 1.5, "1", true, 1e300};
  }
  std::vector<Json> operator()(const RenderOption::Number& kind) const {
    const auto& [min, max, no_min, no_max] = kind.range;
    return {no_min ? min : std::nextafter(min, -HUGE_VAL), no_max ? max : std::nextafter(max, HUGE_VAL), "1",
            true};
  }
  std::vector<Json> operator()(const RenderOption::Point&) const {
    return {Json{0, 0}, Json{0, 0, 0, 0}, Json{0, "x", 0}, Json{0, 0, 2 * kMaxCoordinate}, 0};
  }
  std::vector<Json> operator()(const RenderOption::Flag&) const { return {0, "true"}; }
  std::vector<Json> operator()(const auto&) const { return {"nosuch", "", 0, true}; }
};
// Returns values that the option must reject.
std::vector<Json> invalid_values(const RenderOption& option) {
  return std::visit(InvalidValues(), option.kind);
}

TEST(RenderOptions, HasUniqueNamesAndHelp) {
  std::set<std::string_view> names;
  for (const RenderOption& option : render_options()) {
    EXPECT_TRUE(names.insert(option.key).second) << option.key;
    EXPECT_TRUE(option.short_name.empty() || names.insert(option.short_name).second) << option.key;
    EXPECT_TRUE(option.help.ends_with('.')) << option.key;
    EXPECT_FALSE(option.value_name().empty()) << option.key;
  }
}

TEST(RenderOptions, UsesValidDefaultsForSceneWithoutSettings) {
  Json bare = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
  for (const char* member : {"image", "render"}) bare.erase(member);
  bare["camera"].erase("fov_degrees");
  const RenderSettings settings = resolve(*load(bare), {});
  for (const RenderOption& option : render_options()) {
    ASSERT_TRUE(option.given(default_settings())) << option.key;
    EXPECT_EQ(problem(option, value_of(option, default_settings())), "");
    EXPECT_EQ(option.text(settings), option.text(default_settings())) << option.key;
    EXPECT_EQ(option.given(load(bare)->render), option.in_scene && !option.by_technique) << option.key;
  }
}

// A request may change the technique of its scene. Without an explicit depth, the technique's default
// applies.
TEST(RenderOptions, UsesDepthOfTechniqueByDefault) {
  Json named = sample("paper"), unnamed = named;
  named["render"]["max_depth"] = 4;
  unnamed["render"].erase("max_depth");
  for (const TechniqueType& type : technique_types()) {
    RenderSettings asked;
    asked.technique = type.name;
    EXPECT_EQ(resolve(*load(unnamed), asked).max_depth, type.max_depth) << type.name;
    EXPECT_EQ(resolve(*load(named), asked).max_depth, 4) << type.name;
    unnamed["render"]["technique"] = type.name;
    EXPECT_EQ(resolve(*load(unnamed), {}).max_depth, type.max_depth) << type.name;
    asked.max_depth = 3;
    EXPECT_EQ(resolve(*load(named), asked).max_depth, 3) << type.name;
    const auto row = std::find_if(render_options().begin(), render_options().end(),
                                  [](const RenderOption& option) { return option.key == "max_depth"; });
    const std::string depth = std::to_string(type.max_depth);
    const bool usual = type.max_depth == *default_settings().max_depth;
    EXPECT_NE(row->help.find(usual ? "Default: " + depth : std::string(type.name) + " " + depth),
              std::string_view::npos)
        << type.name;
  }
}

// Under a budget, default and scene settings are relaxed, but settings of the request are kept.
TEST(RenderOptions, RelaxesUnrequestedSettingsUnderBudgets) {
  Json json = sample("paper");
  json["render"].update(
      {{"max_depth", 4}, {"min_contribution", 0.5}, {"precision", "float"}, {"samples", 3}});
  const auto scene = load(json);
  for (const TechniqueType& type : technique_types()) {
    RenderSettings error, seconds;
    error.technique = seconds.technique = type.name;
    error.error = 0.01;
    seconds.seconds = 1;
    EXPECT_EQ(resolve(*scene, error).min_contribution, 1.0 / 16) << type.name;
    EXPECT_EQ(resolve(*scene, seconds).min_contribution, 0.001) << type.name;
    for (RenderSettings asked : {error, seconds}) {
      EXPECT_EQ(resolve(*scene, asked).precision, Precision::double_precision) << type.name;
      EXPECT_EQ(resolve(*scene, asked).samples, kMaxSamples) << type.name;
      EXPECT_EQ(resolve(*scene, asked).max_depth, kMaxDepth) << type.name;
      asked.max_depth = 2;
      asked.precision = Precision::single_precision;
      asked.min_contribution = 0.25;
      EXPECT_EQ(resolve(*scene, asked).max_depth, 2) << type.name;
      EXPECT_EQ(resolve(*scene, asked).min_contribution, 0.25) << type.name;
      EXPECT_EQ(resolve(*scene, asked).precision, Precision::single_precision) << type.name;
    }
  }
}

TEST(RenderOptions, RoundTripsExtremeValues) {
  for (const RenderOption& option : render_options()) {
    ASSERT_GE(extreme_values(option).size(), 2U) << option.key;
    for (const Json& value : extreme_values(option)) {
      SCOPED_TRACE(std::string(option.key) + " " + value.dump());
      ASSERT_EQ(problem(option, value), "");
      const RenderSettings settings = read({{name_of(option.section), {{option.key, value}}}});
      EXPECT_EQ(value_of(option, settings), value);
      EXPECT_EQ(read(Json::parse(to_json(settings))), settings);
      for (const RenderOption& other : render_options())
        EXPECT_EQ(other.given(settings), &other == &option) << other.key;
    }
  }
}

TEST(RenderOptions, RejectsValuesBeyondLimits) {
  for (const RenderOption& option : render_options())
    for (const Json& value : invalid_values(option))
      EXPECT_TRUE(problem(option, value).starts_with(option.pointer())) << option.key << " " << value;
}

TEST(RenderOptions, SharesRangesBetweenSceneAndRequest) {
  for (const RenderOption& option : render_options()) {
    Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]");
    const std::string section(name_of(option.section));
    const std::string unknown = option.section == Section::budget ? "" : "/" + section;  // unknown to scenes
    for (const Json& value : extreme_values(option)) {
      scene[section][option.key] = value;
      EXPECT_EQ(first_problem(scene), option.in_scene ? "accepted" : unknown) << option.key;
      EXPECT_TRUE(!option.in_scene || value_of(option, load(scene)->render) == value) << option.key;
    }
    for (const Json& value : invalid_values(option)) {
      scene[section][option.key] = value;
      EXPECT_TRUE(first_problem(scene).starts_with(option.in_scene ? option.pointer() : unknown))
          << option.key << " " << value;
    }
  }
}

TEST(RenderOptions, PrefersRequestOverScene) {
  for (const RenderOption& option : render_options()) {
    if (!option.in_scene) continue;
    const std::vector<Json> values = extreme_values(option);
    Json json = sample("orrery");  // has motion
    json[std::string(name_of(option.section))][option.key] = values[0];
    const auto scene = load(json);
    const RenderSettings asked = read({{name_of(option.section), {{option.key, values[1]}}}});
    if (option.key == "time") {  // is clamped to the keyframes
      EXPECT_EQ(resolve(*scene, {}).time, scene->motion.first);
      EXPECT_EQ(resolve(*scene, asked).time, scene->motion.last);
    } else {
      EXPECT_EQ(value_of(option, resolve(*scene, {})), values[0]);
      EXPECT_EQ(value_of(option, resolve(*scene, asked)), values[1]);
    }
  }
}

TEST(RenderOptions, OmitsUnsetValues) {
  EXPECT_EQ(to_json({}), "{}");
  EXPECT_EQ(read(Json::object()), RenderSettings());
  RenderSettings settings;
  settings.samples = 4;
  settings.pan = Vec3d(0.5, -0.0, 1e12);
  EXPECT_EQ(to_json(settings), R"({"camera":{"pan":[0.5,0,1e12]},"render":{"samples":4}})");
  EXPECT_EQ(to_json(default_settings()).find("null"), std::string::npos);
  EXPECT_EQ(read(Json::parse(to_json(default_settings()))), default_settings());
}

// No option of the table is a list of names, so this test defines one.
TEST(RenderOptions, SupportsListsOfNames) {
  struct MoreSettings : RenderSettings {
    std::optional<std::vector<std::string>> layers;
  };
  const RenderOption option{
      .key = "layers",
      .section = Section::image,
      .kind = RenderOption::NameList{static_cast<RenderOption::Member<std::vector<std::string>>>(
                                         &MoreSettings::layers),
                                     [] {
                                       return RenderOption::Names{"depth", "normal", "albedo"};
                                     }},
      .help = "Additional channels of the image."};
  EXPECT_EQ(option.value_name(), "depth|normal|albedo");
  EXPECT_EQ(option.form(), RenderOption::Form::strings);
  const auto read_layers = [&](const Json& json) {
    MoreSettings settings;
    read_document(document_of(json), [&](Params& p) { option.read_request(p, settings); });
    return settings;
  };
  EXPECT_FALSE(option.given(read_layers(Json::object())));
  const MoreSettings two = read_layers({{"layers", {"normal", "depth"}}});
  EXPECT_EQ(option.text(two), R"(["normal","depth"])");
  EXPECT_EQ(option.text(read_layers({{"layers", Json::array()}})), "[]");
  EXPECT_THROW(read_layers({{"layers", {"normal", "normals"}}}), InputError);
  EXPECT_THROW(read_layers({{"layers", "normal"}}), InputError);
}

}  // namespace
}  // namespace orrery::test
