#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/channels/registry.h"
#include "core/plan/plan.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// Tests the planned number type. A scene must be rendered in double if float causes visible errors, and the
// plan must state the reason.
namespace orrery::test {
namespace {

constexpr double kMaxError = 5e-4;  // root mean square of radiance, without edges
constexpr float kEdge = 0.1f;       // radiance step between neighbours at an edge

struct View {
  Plan plan;
  Picture picture;
  std::vector<float> objects;
};

View view(const std::shared_ptr<const Scene>& scene, Precision precision) {
  RenderRequest request;
  request.precision = precision;
  request.layers = std::vector<std::string>{"object"};
  const PreparedScene prepared(scene);
  const Plan plan = make_plan(*scene, request);
  const RenderResult result =
      render_frame(prepared, settle(prepared, plan), FilmStorage::sums, shared_executor());
  View seen{plan, {plan.width, plan.height, {}, result.stats}, result.film.values(0, 0)};
  seen.picture.pixels.resize(static_cast<std::size_t>(plan.width * plan.height));
  const Image image = result.film.image(PixelFormat::linear32);
  std::memcpy(static_cast<void*>(seen.picture.pixels.data()), image.bytes().data(), image.bytes().size());
  return seen;
}

// Returns true if the 3 x 3 neighbourhood contains another object or a radiance step above kEdge.
bool is_edge(const View& seen, int x, int y) {
  const auto object = [&](int i, int k) {
    return seen.objects[static_cast<std::size_t>(k * seen.picture.width + i)];
  };
  for (int k = std::max(0, y - 1); k <= std::min(seen.picture.height - 1, y + 1); ++k)
    for (int i = std::max(0, x - 1); i <= std::min(seen.picture.width - 1, x + 1); ++i)
      if (object(i, k) != object(x, y) ||
          max_component(abs(seen.picture.at(i, k) - seen.picture.at(x, y))) > kEdge)
        return true;
  return false;
}

// Returns the root mean square difference from `right`, without the edges of `right`.
double error_off_edges(const View& seen, const View& right) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < right.picture.height; ++y)
    for (int x = 0; x < right.picture.width; ++x) {
      if (is_edge(right, x, y)) continue;
      const Vec3d d = Vec3d(seen.picture.at(x, y)) - Vec3d(right.picture.at(x, y));
      sum += dot(d, d) / 3;
      ++count;
    }
  return std::sqrt(sum / std::max(1, count));
}

double error_of_choice(const std::shared_ptr<const Scene>& scene) {
  const View chosen = view(scene, Precision::automatic);
  return chosen.plan.double_precision ? 0 : error_off_edges(chosen, view(scene, Precision::double_precision));
}

Json from_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  return Json::parse(file);
}

class PrecisionScene : public testing::TestWithParam<std::string> {};

std::vector<std::string> hard_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("tests/scenes/precision"))
    names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

TEST_P(PrecisionScene, MatchesDoublePrecision) {
  EXPECT_LE(error_of_choice(load(from_file("tests/scenes/precision/" + GetParam() + ".json"))), kMaxError);
}
INSTANTIATE_TEST_SUITE_P(Scenes, PrecisionScene, testing::ValuesIn(hard_scenes()), [](const auto& test) {
  std::string name = test.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(Precision, UsesFloatWithoutVisibleErrorForSampleScenes) {
  for (const std::string& name : sample_names()) {
    Json scene = sample(name);
    const bool small = reduced();
    scene["image"] = {{"width", small ? 32 : 96}, {"height", small ? 24 : 72}};
    const auto loaded = load(scene);
    EXPECT_FALSE(make_plan(*loaded, {}).double_precision) << name;
    EXPECT_LE(error_of_choice(loaded), kMaxError) << name;
  }
}

// Returns a lattice of tilted tubes, three by three, that touch at height `gap` below the floor. Scenes of
// this kind multiply rounding errors at each reflection in a narrow gap.
Json mirror_tubes(double radius, double gap, int depth) {
  Json scene = from_file("tests/scenes/precision/mirror_tubes_0.3_depth_5.json");
  Json objects = Json::array();
  const double apart = 2 * radius + gap;
  for (int x = -1; x <= 1; ++x)
    for (int z = -1; z <= 1; ++z)
      objects.push_back({{"type", "cylinder"},
                         {"point", {x * apart, 0, z * apart}},
                         {"axis", {0.1 * x, 1, 0.1 * z}},
                         {"radius", radius},
                         {"material", "s"}});
  for (const Json& object : scene["objects"])
    if (object["material"] != "s") objects.push_back(object);
  scene["objects"] = objects;
  scene["image"] = {{"width", 64}, {"height", 64}};
  scene["render"] = {{"max_depth", depth}};
  return scene;
}
// Returns mirror balls in a row and a floor.
Json mirror_balls(double radius, double gap, int depth) {
  Json scene = mirror_tubes(radius, gap, depth);
  Json objects = Json::array();
  const double apart = 2 * radius + gap;
  for (int x = -1; x <= 1; ++x)
    for (int y = 0; y <= 1; ++y)
      objects.push_back({{"type", "sphere"},
                         {"center", {x * apart, radius + y * apart, 0.3 * y}},
                         {"radius", radius},
                         {"material", "s"}});
  for (const Json& object : scene["objects"])
    if (object["material"] != "s") objects.push_back(object);
  scene["objects"] = objects;
  return scene;
}

// Float is chosen only if its image differs from double by at most the limit.
TEST(Precision, UsesDoubleForMirrorsThatNearlyTouch) {
  int in_double = 0, needed = 0, scenes = 0;
  for (const auto& make : {mirror_tubes, mirror_balls})
    for (const double radius : {0.2, 0.35, 0.5, 0.8})
      for (const double gap : {0.0, 0.01, 0.1, 0.4})
        for (const int depth : {2, 5, 8, 12, 32}) {
          const auto scene = load(make(radius, gap, depth));
          const double error = error_off_edges(view(scene, Precision::single_precision),
                                               view(scene, Precision::double_precision));
          const bool chosen = make_plan(*scene, {}).double_precision;
          ++scenes;
          in_double += chosen;
          needed += error > kMaxError;
          EXPECT_TRUE(chosen || error <= kMaxError)
              << "radius " << radius << ", gap " << gap << ", depth " << depth << ": error " << error;
        }
  std::printf("%d scenes, %d planned in double, %d need it\n", scenes, in_double, needed);
  EXPECT_GT(needed, scenes / 10);
}

// The layers of this scene approach each other only during the motion.
TEST(Precision, UsesSmallestGapDuringMotion) {
  const auto scene = load(from_file("tests/scenes/closing_gap.json"));
  EXPECT_TRUE(make_plan(*scene, {}).double_precision);
}

// The reason names the element that needs double precision.
TEST(Precision, ReportsReasonForDouble) {
  const auto reason = [](const std::string& name) {
    const Plan plan = make_plan(*load(from_file("tests/scenes/precision/" + name + ".json")), {});
    EXPECT_TRUE(plan.double_precision) << name;
    for (const Decision& decision : plan.decisions)
      if (decision.subject == "precision") return decision.reason;
    return std::string();
  };
  EXPECT_THAT(reason("spot_0.05_degrees"), testing::HasSubstr("/lights/0"));
  EXPECT_THAT(reason("shininess_1e+06"), testing::HasSubstr("exponent of 1e6"));
  EXPECT_THAT(reason("plane_point_1e+06_away"), testing::HasSubstr("(/objects/0)"));
  EXPECT_THAT(reason("tube_point_100000_away"), testing::HasSubstr("(/objects/0)"));
  EXPECT_THAT(reason("decal_1e-07_above_floor"), testing::HasSubstr("/objects/0 is 9.99"));
  EXPECT_THAT(reason("bubble_1e-06_thick"), testing::HasSubstr("from the nearest other surface"));
  EXPECT_THAT(reason("film_1e-06_thick_10_wide"), testing::HasSubstr("/objects/0 is 9.99"));
  EXPECT_THAT(reason("mirror_tubes_0.3_depth_5"), testing::HasSubstr("5 reflections"));
  EXPECT_THAT(reason("mesh_of_size_1e-14"), testing::HasSubstr("underflow in float"));
  EXPECT_THAT(reason("tele_1e-4_look_at_10000_away"), testing::HasSubstr("a pixel is 1.27"));
}

TEST(Precision, ConsidersPositionOfInstancedPlanes) {
  const auto scene = load(scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]",
                                   "{'models': {'floor': {'objects': [{'type': 'plane', 'point': [0, 0, 0],"
                                   " 'normal': [0, 1, 0.3], 'material': 'white'}]}},"
                                   " 'instances': [{'model': 'floor', 'translate': [1e6, 0, 1e6]}]}"));
  const Plan plan = make_plan(*scene, {});
  EXPECT_TRUE(plan.double_precision);
  EXPECT_EQ(scene->facts.magnitude.where, "/instances/0");
}

// Scenes that are too small for float render correctly in double, down to the smallest size that the format
// allows.
TEST(Precision, StaysExactForTinyScenes) {
  const Json tiny = from_file("tests/scenes/precision/mesh_of_size_1e-14.json");
  const Picture large = render(scaled(tiny, 0x1p47), in_double());
  for (const double factor : {1.0, 0x1p-100, 0x1p-250}) {
    EXPECT_TRUE(make_plan(*load(scaled(tiny, factor)), {}).double_precision);
    EXPECT_TRUE(identical(render(scaled(tiny, factor)), large)) << factor;
  }
  EXPECT_EQ(first_problem(scaled(tiny, 1e-80)), "/objects/0");
}

// ---- random scenes with features that are hard for float

class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed) {}

  Json make() {
    add_materials();
    const int count = 2 + static_cast<int>(random_.between(0, 7));
    for (int i = 0; i < count; ++i) add_object();
    if (one_of(3)) add_floor();
    if (one_of(6)) add_layer();
    add_lights();
    scene_["version"] = 1;
    scene_["camera"] = camera();
    scene_["image"] = {{"width", 48}, {"height", 48}};
    scene_["ambient"] = {0.1, 0.1, 0.1};
    scene_["background"] = {0.2, 0.3, 0.5};
    scene_["render"] = {{"max_depth", 1 + static_cast<int>(random_.between(0, 7))}};
    Json placed = one_of(4) ? scaled(scene_, random_.magnitude(1e-3, 1e3)) : scene_;
    return one_of(4) ? moved(placed, random_.direction() * random_.magnitude(1, 1e6)) : placed;
  }

 private:
  bool one_of(int n) { return random_.between(0, n) < 1; }

  void add_materials() {
    Json& m = scene_["materials"];
    m["matt"] = {{"type", "rough"}, {"kd", 0.8}};
    m["shiny"] = {{"type", "rough"},
                  {"kd", 0.3},
                  {"ks", 0.5},
                  {"shininess", one_of(6) ? random_.magnitude(1e3, 1e6) : random_.magnitude(1, 500)}};
    m["metal"] = {{"type", "reflective"}, {"n", {0.1, 0.2, 0.3}}, {"k", {5, 5, 5}}};
    m["glass"] = {{"type", "refractive"}, {"ior", 1.5}, {"fresnel", "exact"}};
  }
  std::string material() {
    const double pick = random_.unit();
    return pick < 0.5 ? "matt" : pick < 0.7 ? "shiny" : pick < 0.85 ? "metal" : "glass";
  }
  double size() { return one_of(10) ? random_.magnitude(1e-4, 0.1) : random_.between(0.1, 0.8); }

  void add_object() {
    const Vec3d at = random_.in_cube(2), toward = random_.direction();
    const double r = size();
    Json object;
    switch (static_cast<int>(random_.between(0, 6))) {
      case 0: object = {{"type", "sphere"}, {"center", numbers(at)}, {"radius", r}}; break;
      case 1: {
        Vec3d half(r, size(), size());
        if (one_of(8)) half.y = random_.magnitude(1e-7, 1e-3);
        object = {{"type", "box"}, {"min", numbers(at - half)}, {"max", numbers(at + half)}};
        break;
      }
      case 2:
        object = {{"type", "disk"}, {"center", numbers(at)}, {"normal", numbers(toward)}, {"radius", r}};
        break;
      case 3:
        object = {{"type", "cylinder"},
                  {"base", numbers(at)},
                  {"top", numbers(at + toward * size())},
                  {"radius", r}};
        break;
      case 4: {
        const Vec3d beside = random_.direction() * (one_of(5) ? random_.magnitude(1e-6, 1e-2) : 1.0);
        object = {{"type", "triangle"},
                  {"vertices", {numbers(at), numbers(at + toward * (3 * r)), numbers(at + beside)}}};
        break;
      }
      default: {
        const double away = one_of(4) ? random_.magnitude(10, 1e6) : 1.0;
        object = {{"type", "cylinder"},
                  {"point", numbers(at + toward * away)},
                  {"axis", numbers(toward)},
                  {"radius", 0.3 * r}};
      }
    }
    object["material"] = material();
    scene_["objects"].push_back(object);
  }
  void add_floor() {
    const double away = one_of(4) ? random_.magnitude(10, 1e7) : 0.0;
    scene_["objects"].push_back(
        {{"type", "plane"}, {"point", {away, -2, 0}}, {"normal", {0, 1, 0}}, {"material", "matt"}});
  }
  // Adds two nearly coincident surfaces.
  void add_layer() {
    const double gap = random_.magnitude(1e-8, 1e-2);
    const Vec3d normal = random_.direction(), at = random_.in_cube(1);
    if (one_of(2)) {
      for (const double radius : {0.9, 0.9 - gap})
        scene_["objects"].push_back(
            {{"type", "sphere"}, {"center", numbers(at)}, {"radius", radius}, {"material", "glass"}});
    } else {
      for (const double radius : {1.5, 1.0})
        scene_["objects"].push_back({{"type", "disk"},
                                     {"center", numbers(at + normal * (radius == 1 ? gap : 0))},
                                     {"normal", numbers(normal)},
                                     {"radius", radius},
                                     {"material", radius == 1 ? "shiny" : "matt"}});
    }
  }
  void add_lights() {
    const int count = 1 + static_cast<int>(random_.between(0, 3));
    for (int i = 0; i < count; ++i) {
      const Vec3d from = random_.direction() * random_.between(3, 6);
      if (one_of(3)) {
        scene_["lights"].push_back({{"type", "directional"}, {"direction_to_light", numbers(from)}});
      } else if (one_of(2)) {
        scene_["lights"].push_back({{"type", "point"}, {"position", numbers(from)}});
      } else {
        const double outer = one_of(3) ? random_.magnitude(0.01, 10) : random_.between(10, 60);
        scene_["lights"].push_back({{"type", "spot"},
                                    {"position", numbers(from)},
                                    {"direction", numbers(-from)},
                                    {"inner_degrees", outer * random_.unit()},
                                    {"outer_degrees", outer}});
      }
    }
  }
  Json camera() {
    const Vec3d eye = random_.direction() * random_.between(4, 7);
    const Vec3d look_at = eye - eye * (one_of(8) ? random_.magnitude(1, 1e4) : 1.0) + random_.in_cube(0.5);
    const double fov = one_of(6) ? random_.magnitude(1e-4, 10) : random_.between(20, 60);
    return {{"type", "perspective"},
            {"eye", numbers(eye)},
            {"look_at", numbers(look_at)},
            {"up", numbers(random_.direction())},
            {"fov_degrees", fov}};
  }

  Random random_;
  Json scene_;
};

TEST(Precision, MatchesDoubleForRandomScenes) {
  constexpr int kScenes = 500;
  int in_float = 0, float_suffices = 0, float_errs = 0;
  double worst = 0;
  for (int seed = 0; seed < kScenes; ++seed) {
    const auto scene = load(RandomScene(static_cast<std::uint64_t>(seed)).make());
    const View right = view(scene, Precision::double_precision);
    const double error = error_off_edges(view(scene, Precision::single_precision), right);
    const Plan plan = make_plan(*scene, {});
    (error > kMaxError ? float_errs : float_suffices) += 1;
    if (plan.double_precision) continue;
    ++in_float;
    worst = std::max(worst, error);
    EXPECT_LE(error, kMaxError) << "seed " << seed;
  }
  RecordProperty("scenes in float", in_float);
  RecordProperty("scenes for which float suffices", float_suffices);
  std::printf("%d of %d scenes planned in float (worst error %.2g), float suffices for %d\n", in_float,
              kScenes, worst, float_suffices);
  EXPECT_GT(float_errs, kScenes / 20) << "too few scenes need double";
  EXPECT_GT(in_float, 0.4 * float_suffices);
}

}  // namespace
}  // namespace orrery::test
