#include "server/api/render_options.h"

#include <gtest/gtest.h>

#include "core/render/views.h"
#include "server/api/explain.h"
#include "server/rendering/picture_key.h"
#include "tests/support/pictures.h"

// Tests textual render options, and their effect on the cache key of an image.
namespace orrery::test {
namespace {

// Returns a scene in which every option changes the image. Facing mirrors reveal depth and ray weight, edges
// reveal samples and seed, and one ball moves. A matt ball is in front of a matt wall.
Json revealing_scene() {
  return scene_of(R"([
      {'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0], 'material': 'mirror'},
      {'type': 'plane', 'point': [0, 2, 0], 'normal': [0, -1, 0], 'material': 'mirror'},
      {'type': 'sphere', 'center': [0.4, 0, 0], 'radius': 0.6, 'material': 'plum'},
      {'type': 'sphere', 'center': [-0.8, 1.1, 0.4], 'radius': 0.4, 'material': 'chalk'},
      {'type': 'plane', 'point': [0, 0, -2], 'normal': [0, 0, 1], 'material': 'chalk'},
      {'type': 'box', 'min': [-1.5, -0.8, -1], 'max': [-0.6, 0.3, 0.2], 'material': 'mirror'}])",
                  R"({'image': {'width': 32, 'height': 24},
      'render': {'samples': 4, 'filter': 'gaussian'},
      'camera': {'eye': [0.3, 0.5, 4]},
      'background': [0.2, 0.3, 0.4],
      'ambient': [0.2, 0.2, 0.3],
      'lights': [{'type': 'point', 'position': [1, 1.5, 3]}],
      'materials': {'chalk': {'type': 'lambert'},
                    'mirror': {'type': 'reflective', 'n': [0.14, 0.16, 0.13], 'k': [4.1, 2.3, 3.1]},
                    'plum': {'type': 'rough', 'kd': [0.6, 0.1, 0.4], 'ks': 0.5}},
      'models': {'ball': {'objects': [
          {'type': 'sphere', 'center': [0, 0, 1], 'radius': 0.3, 'material': 'plum'}]}},
      'instances': [{'model': 'ball', 'motion': [{'time': 0}, {'time': 2, 'translate': [1, 0, 0]}]}]})");
}

// Requests with values of the option other than `own`: one for a number, all others for a choice.
struct OtherValues {
  const RenderSettings& own;

  template <class Kind, class V>
  static RenderRequest with(const Kind& kind, const V& value) {
    RenderRequest request;
    request.*kind.member = value;
    return request;
  }
  template <class I>
  std::vector<RenderRequest> operator()(const RenderOption::Integer<I>& kind) const {
    const I next = *(own.*kind.member) + 1;
    return {with(kind, next), with(kind, 2 * next)};
  }
  std::vector<RenderRequest> operator()(const RenderOption::Number& kind) const {
    return {with(kind, *(own.*kind.member) + 1)};
  }
  std::vector<RenderRequest> operator()(const RenderOption::Flag& kind) const {
    return {with(kind, !*(own.*kind.member))};
  }
  std::vector<RenderRequest> operator()(const RenderOption::Point& kind) const {
    return {with(kind, *(own.*kind.member) + Vec3d(0.5, 0, 0))};
  }
  std::vector<RenderRequest> operator()(const RenderOption::Name& kind) const {
    std::vector<RenderRequest> others;
    for (const std::string_view name : kind.names())
      if (name != *(own.*kind.member)) others.push_back(with(kind, std::string(name)));
    return others;
  }
  template <class E>
  std::vector<RenderRequest> operator()(const RenderOption::Enumeration<E>& kind) const {
    std::vector<RenderRequest> others;
    for (std::size_t i = 0; i < kind.names.size(); ++i)
      if (E(i) != *(own.*kind.member)) others.push_back(with(kind, E(i)));
    return others;
  }
  std::vector<RenderRequest> operator()(const RenderOption::NameList& kind) const {
    return {with(kind, std::vector<std::string>{std::string(kind.names().front())})};
  }
};

// Renders to EXR, which stores the pixels without loss.
std::string file_of(const std::shared_ptr<const Scene>& scene, const RenderRequest& request) {
  const PreparedScene prepared(scene);
  const SettledPlan plan = settle(prepared, make_plan(*scene, request));
  const FilmStorage storage = storage_for(FileFormat::exr, *plan);
  return encode_film(render_frame(prepared, plan, storage, shared_executor()).film, FileFormat::exr);
}

// The cache key of an image contains an option if and only if its table row has `changes_pixels`. The
// rendered pixels confirm the row.
TEST(RenderOptions, ChangesKeyIfAndOnlyIfPixelsChange) {
  const auto scene = load(revealing_scene());
  const RenderSettings own = resolve(*scene, {});
  const auto by = [](RenderRequest request, const char* technique) {
    request.technique = technique;
    return request;
  };
  const std::string plain = file_of(scene, {}), plain_paths = file_of(scene, by({}, "path")),
                    plain_vertices = file_of(scene, by({}, "gouraud"));
  for (const RenderOption& option : render_options()) {
    if (option.key == "error_metric") continue;  // tested separately below
    const std::vector<RenderRequest> others = std::visit(OtherValues{own}, option.kind);
    ASSERT_FALSE(others.empty()) << option.key;
    bool changed = false;
    for (const RenderRequest& request : others) {
      SCOPED_TRACE(to_json(request));
      EXPECT_EQ(etag_of(*scene, request) != etag_of(*scene, {}), option.changes_pixels);
      EXPECT_EQ(canonical_request(*scene, request) != canonical_request(*scene, {}), option.changes_pixels);
      EXPECT_NE(canonical_work(*scene, request), canonical_work(*scene, {}));
      const bool same = file_of(scene, request) == plain &&
                        (request.technique || (file_of(scene, by(request, "path")) == plain_paths &&
                                               file_of(scene, by(request, "gouraud")) == plain_vertices));
      changed = changed || !same;
      EXPECT_TRUE(same || option.changes_pixels);
    }
    EXPECT_EQ(changed, option.changes_pixels) << option.key << ": no value changes this scene";
  }
}

TEST(RenderOptions, IncludesErrorSpaceInKey) {
  const auto scene = load(revealing_scene());
  RenderRequest linear, display;
  linear.error = display.error = 0.1;
  display.space = Space::display;
  EXPECT_NE(etag_of(*scene, linear), etag_of(*scene, display));
  EXPECT_TRUE(file_of(scene, linear) != file_of(scene, display));
}

TEST(RenderOptions, KeepsKeyForValuesEqualToScene) {
  const auto scene = load(revealing_scene());
  RenderRequest request;
  static_cast<RenderSettings&>(request) = resolve(*scene, {});
  EXPECT_EQ(etag_of(*scene, request), etag_of(*scene, {}));
  request.time = -5;  // before the motion begins
  EXPECT_EQ(etag_of(*scene, request), etag_of(*scene, {}));
}

RenderRequest read(std::string_view name, const std::string& text) {
  const OptionText given{find_render_option(name), "--" + std::string(name), text};
  return read_option_texts({&given, 1});
}

std::string problem(std::string_view name, const std::string& text) {
  try {
    read(name, text);
  } catch (const InputError& error) {
    return error.problems().front().pointer + ": " + error.problems().front().detail;
  }
  return "accepted";
}

TEST(OptionTexts, RoundTripsUnderEveryName) {
  for (const RenderOption& option : render_options()) {
    std::string text = option.text(default_settings());
    std::erase_if(text, [](char c) { return c == '"' || c == '[' || c == ']'; });
    for (const std::string_view name : {option.key, option.short_name}) {
      if (name.empty()) continue;
      RenderSettings expected;
      option.copy(default_settings(), expected);
      EXPECT_EQ(static_cast<const RenderSettings&>(read(name, text)), expected) << name << " " << text;
    }
  }
  EXPECT_EQ(read("fov", "60").fov_degrees, 60);
  EXPECT_EQ(read("pan", "1,-2.5,3e2").pan, Vec3d(1, -2.5, 300));
  EXPECT_EQ(find_render_option("nosuch"), nullptr);
  EXPECT_EQ(find_render_option(""), nullptr);
}

TEST(OptionTexts, ReportsErrorsUnderGivenName) {
  EXPECT_EQ(problem("azimuth", "x"), R"(--azimuth: must be a number from -1e9 to 1e9 (got "x"))");
  EXPECT_EQ(problem("azimuth_degrees", "nan").substr(0, 18), "--azimuth_degrees:");
  EXPECT_EQ(problem("pan", "1,x,3").substr(0, 8), "--pan/1:");
  EXPECT_EQ(problem("technique", "5").substr(0, 12), "--technique:");
  EXPECT_EQ(problem("technique", "whitted,raycast").substr(0, 12), "--technique:");
  EXPECT_EQ(problem("reorder", "maybe"), R"(--reorder: must be true or false (got "maybe"))");
  EXPECT_EQ(problem("samples", "").substr(0, 10), "--samples:");
}

}  // namespace
}  // namespace orrery::test
