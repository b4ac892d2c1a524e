#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Tests transparent bodies that contain, touch or overlap each other.
namespace orrery::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
const Json kGlass{{"type", "refractive"}, {"ior", 1.5}, {"fresnel", "exact"}};
const Json kWater{{"type", "refractive"}, {"ior", 1.33}, {"fresnel", "exact"}};

Json fog(const Vec3d& filter, double priority = 0) {
  return {{"type", "refractive"},
          {"ior", 1},
          {"fresnel", "exact"},
          {"filter", numbers(filter)},
          {"priority", priority}};
}
Json with(Json material, const char* key, const Json& value) {
  material[key] = value;
  return material;
}
// Returns a box around the z axis from z = `low` to `high`.
Json layer(double low, double high, double half, const char* material) {
  return {{"type", "box"}, {"min", {-half, -half, low}}, {"max", {half, half, high}}, {"material", material}};
}
Json ball(const Vec3d& centre, double radius, const char* material) {
  return {{"type", "sphere"}, {"center", numbers(centre)}, {"radius", radius}, {"material", material}};
}
// Returns a scene under a sky of radiance 1.
Json scene(const Json& objects, Json materials) {
  if (!materials.contains("white")) materials["white"] = {{"type", "rough"}, {"kd", {0.6, 0.3, 0.1}}};
  return scene_with(objects, Json{{"materials", materials}, {"background", {1, 1, 1}}});
}
// Moves the eye, so that the plan looks for bodies around it.
Json seen_from(Json scene, const Vec3d& eye) {
  scene["camera"]["eye"] = numbers(eye);
  return scene;
}
RenderRequest deep(int max_depth, double min_contribution = 0) {
  RenderRequest request;
  request.max_depth = max_depth;
  request.min_contribution = min_contribution;
  return request;
}
Ray<double> slanted(double degrees, const Vec3d& through) {
  const Vec3d direction(std::sin(degrees * kRadians), 0, -std::cos(degrees * kRadians));
  return {through - direction, direction};
}
double angle_of(const Vec3d& direction) { return std::atan2(direction.x, -direction.z) / kRadians; }
// Returns whether a traced ray has an angle to the -z axis within 1e-9 degrees.
bool has_angle(const Tracing& tracing, double degrees) {
  for (const auto& generation : tracing.rays())
    for (const auto& ray : generation)
      if (std::abs(angle_of(ray.direction) - degrees) < 1e-9) return true;
  return false;
}

// Fractions of light that a stack of parallel layers transmits, and reflects on its first and last side,
// without interference.
struct Stack {
  long double transmitted = 1, front = 0, back = 0;

  Stack then(const Stack& next) const {
    const long double rest = 1 - back * next.front;
    return {transmitted * next.transmitted / rest, front + transmitted * transmitted * next.front / rest,
            next.back + next.transmitted * next.transmitted * back / rest};
  }
};
// Fresnel's equations for unpolarized light. `sine` is the sine of the angle in air.
Stack interface(long double from, long double to, long double sine) {
  const long double a = std::sqrt(1 - sine * sine / (from * from)),
                    b = std::sqrt(1 - sine * sine / (to * to));
  const long double s = (from * a - to * b) / (from * a + to * b),
                    p = (to * a - from * b) / (to * a + from * b);
  const long double r = (s * s + p * p) / 2;
  return {1 - r, r, r};
}
Stack absorber(long double per_metre, long double thickness, long double index, long double sine) {
  return {std::pow(per_metre, thickness / std::sqrt(1 - sine * sine / (index * index)))};
}

TEST(NestedMedia, MatchesPlatesOfThreeMedia) {
  covers("R16 R17");
  const Json dyed = with(kGlass, "filter", {0.5, 0.5, 0.5}), sea = with(kWater, "filter", {0.8, 0.8, 0.8});
  Json objects = {layer(-1.5, 1.5, 200, "sea"), layer(-0.5, 0.5, 180, "dyed")};
  objects.push_back({{"type", "plane"}, {"point", {0, 0, 9}}, {"normal", {0, 0, -1}}, {"material", "black"}});
  const Json plates =
      scene(objects, {{"sea", sea}, {"dyed", dyed}, {"black", {{"type", "rough"}, {"kd", 0}}}});
  double worst = 0;
  for (const double degrees : {0.0, 30.0, 45.0, 60.0}) {
    const long double sine =
        std::sin(static_cast<long double>(degrees) * std::numbers::pi_v<long double> / 180);
    const Stack outer = absorber(0.8L, 1, 1.33L, sine), inner = absorber(0.5L, 1, 1.5L, sine);
    const Stack all = interface(1, 1.33L, sine)
                          .then(outer)
                          .then(interface(1.33L, 1.5L, sine))
                          .then(inner)
                          .then(interface(1.5L, 1.33L, sine))
                          .then(outer)
                          .then(interface(1.33L, 1, sine));
    const double found = Tracing(plates, deep(24, 1e-12)).trace(slanted(degrees, {0, 0, 1.5})).radiance.x;
    worst = std::max(worst, std::abs(found - static_cast<double>(all.transmitted)));
  }
  EXPECT_LE(worst, 1e-10);
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(NestedMedia, HidesBodyOfSameIndex) {
  for (const char* type : {"refractive", "glass"})
    for (const char* technique : {"whitted", "distributed", "path"}) {
      const Json glass = type[0] == 'g' ? Json{{"type", "glass"}} : Json{{"type", type}, {"ior", 1.5}};
      Json alone =
          scene({ball({0, 0, 0}, 1, "a"), layer(-3, -2.9, 0.6, "white")}, {{"a", glass}, {"b", glass}});
      alone["ambient"] = {0.5, 0.5, 0.5};
      Json nested = alone;
      nested["objects"].push_back(ball({0.1, 0, 0}, 0.7, "b"));
      RenderRequest request = in_double(size(24, 24));
      request.technique = technique;
      request.samples = 2;
      request.reuse = 1;
      EXPECT_LE(largest_difference(render(alone, request), render(nested, request)), 1e-6)
          << type << technique;
    }
}

// Camera rays that pass invisible surfaces collect the light behind them.
TEST(NestedMedia, ShowsLightBehindBodiesOfAir) {
  for (const char* type : {"refractive", "glass"})
    for (const char* technique : {"whitted", "distributed", "path"}) {
      const Json air{{"type", type}, {"ior", 1}};
      Json bodies =
          scene({ball({0, 0, 0}, 1, "air"), ball({0.2, 0, 0}, 0.5, "air"), layer(-3, -2, 50, "lamp")},
                {{"air", air}, {"lamp", {{"type", "lambert"}, {"reflectance", 0}, {"emission", {3, 2, 1}}}}});
      Json alone = bodies;
      alone["objects"] = {bodies["objects"][2]};
      RenderRequest request = in_double(size(24, 24));
      request.technique = technique;
      request.samples = 2;
      request.reuse = 1;
      EXPECT_LE(largest_difference(render(alone, request), render(bodies, request)), 1e-6)
          << type << technique;
    }
}

// Shadow rays that stay inside a body are attenuated.
TEST(NestedMedia, AttenuatesLightOfLampsInside) {
  for (const char* technique : {"whitted", "distributed", "path"}) {
    Json ink = scene({layer(-2, 2, 5, "ink"), layer(-1, -0.5, 4, "white")}, {{"ink", fog({0.5, 1, 0.25})}});
    ink["background"] = {0, 0, 0};
    Json clear = ink;
    clear["materials"]["ink"] = fog({1, 1, 1});
    for (Json* one : {&ink, &clear}) (*one)["lights"] = {{{"type", "point"}, {"position", {0, 0, 1}}}};
    RenderRequest request = deep(3);
    request.technique = technique;
    const Ray<double> down{{0, 0, 5}, {0, 0, -1}};  // 2.5 m inside the ink, and 1.5 m from the lamp
    const Vec3d seen = Tracing(ink, request).trace(down).radiance,
                without = Tracing(clear, request).trace(down).radiance;
    const Vec3d expected(without.x * std::pow(0.5, 4), without.y, without.z * std::pow(0.25, 4));
    EXPECT_GT(without.x, 0.01) << technique;
    EXPECT_LE(length(seen - expected), 1e-9) << technique;
  }
}

// A bubble turns rays away from its axis by twice the difference of the angles at its surface.
TEST(NestedMedia, DivergesRaysAtBubble) {
  const Json bubble = scene({layer(-3, 3, 9, "glass"), ball({0, 0, 0}, 1, "air")},
                            {{"glass", kGlass}, {"air", with(kWater, "ior", 1)}});
  for (const double height : {0.1, 0.3, 0.6}) {
    Tracing tracing(bubble, deep(3));
    tracing.trace(Ray<double>{{height, 0, 5}, {0, 0, -1}});
    const double inside = std::asin(height) / kRadians, out = std::asin(1.5 * height) / kRadians;
    EXPECT_TRUE(has_angle(tracing, out - inside)) << height;
    EXPECT_TRUE(has_angle(tracing, 2 * (out - inside))) << height;
  }
  Tracing total(bubble, deep(2));
  total.trace(Ray<double>{{0.7, 0, 5}, {0, 0, -1}});
  EXPECT_EQ(total.counts().rays.refracted[2], 0u) << "beyond the critical angle, the bubble only reflects";
}

TEST(NestedMedia, ReflectsTotallyAtInnerInterfaceOnly) {
  const Json plates = seen_from(
      scene({layer(-9, 1, 90, "glass"), layer(-3, 0, 80, "water")}, {{"glass", kGlass}, {"water", kWater}}),
      {0, 0, 0.5});
  const double critical = std::asin(1.33 / 1.5) / kRadians;
  for (const double degrees : {30.0, 55.0, critical - 0.01}) {
    Tracing tracing(plates, deep(1));
    tracing.trace(slanted(degrees, {0, 0, 0}));  // from a point in glass
    EXPECT_TRUE(has_angle(tracing, std::asin(1.5 / 1.33 * std::sin(degrees * kRadians)) / kRadians));
    EXPECT_EQ(tracing.counts().rays.refracted[1], 1u);
  }
  Tracing tracing(plates, deep(1));
  tracing.trace(slanted(critical + 0.01, {0, 0, 0}));
  EXPECT_EQ(tracing.counts().rays.refracted[1], 0u);
  EXPECT_EQ(tracing.counts().rays.reflected[1], 1u);
}

TEST(NestedMedia, FindsMediaAroundEye) {
  const Json plates =
      scene({layer(-2, 2, 90, "glass"), layer(-1, 1, 80, "water"), ball({0, 0, 0}, 0.5, "air")},
            {{"glass", kGlass}, {"water", kWater}, {"air", with(kWater, "ior", 1)}});
  Tracing from_water(seen_from(plates, {1, 0, -0.8}), deep(2));
  from_water.trace(Ray<double>{{1, 0, -0.8}, slanted(30, {}).direction});
  EXPECT_TRUE(has_angle(from_water, std::asin(1.33 / 1.5 * 0.5) / kRadians));
  EXPECT_TRUE(has_angle(from_water, std::asin(1.33 * 0.5) / kRadians));
  Tracing from_bubble(seen_from(plates, {0.25, 0, 0}), deep(1));
  from_bubble.trace(Ray<double>{{0.25, 0, 0}, {0, 0, -1}});
  const double inside = std::asin(0.5) / kRadians, out = std::asin(0.5 / 1.33) / kRadians;
  EXPECT_TRUE(has_angle(from_bubble, out - inside) || has_angle(from_bubble, inside - out));
}

TEST(NestedMedia, AbsorbsByBodyOfHighestPriority) {
  const Vec3d red(0.5, 1, 1), blue(1, 1, 0.25);
  const auto seen = [&](double first, double second, double half, double from, double toward) {
    const Json overlapping = scene({layer(0, 2, 5, "red"), layer(1, 3, half, "blue")},
                                   {{"red", fog(red, first)}, {"blue", fog(blue, second)}});
    return Tracing(overlapping, deep(5)).trace(Ray<double>{{0.1, 0.2, from}, {0, 0, toward}}).radiance;
  };
  for (const double half : {5.0, 4.0})  // faces in one plane need a probe
    for (const double from : {-4.0, 8.0}) {
      const double toward = from < 0 ? 1 : -1;
      EXPECT_LE(length(seen(1, 0, half, from, toward) - Vec3d(0.25, 1, 0.25)), 1e-9) << half << from;
      EXPECT_LE(length(seen(0, 1, half, from, toward) - Vec3d(0.5, 1, 0.0625)), 1e-9) << half << from;
    }
  EXPECT_LE(length(seen(0, 0, 4, -4, 1) - Vec3d(0.5, 1, 0.0625)), 1e-9) << "blue is entered last";
  EXPECT_LE(length(seen(0, 0, 4, 8, -1) - Vec3d(0.25, 1, 0.25)), 1e-9) << "red is entered last";
}

TEST(NestedMedia, TreatsTouchingBodiesAsOneSlab) {
  covers("D8");
  const auto passed = [](const Json& second) {
    const Json touching =
        scene({layer(-0.5, 0, 90, "first"),
               layer(0, 0.5, 90, "second"),
               {{"type", "plane"}, {"point", {0, 0, 9}}, {"normal", {0, 0, -1}}, {"material", "black"}}},
              {{"first", kGlass}, {"second", second}, {"black", {{"type", "rough"}, {"kd", 0}}}});
    return Tracing(touching, deep(24, 1e-12)).trace(slanted(0, {0.3, 0.4, 0.5})).radiance.x;
  };
  EXPECT_NEAR(passed(kGlass), 12.0 / 13, 1e-11);
  const Stack three = interface(1, 1.33L, 0).then(interface(1.33L, 1.5L, 0)).then(interface(1.5L, 1, 0));
  EXPECT_NEAR(passed(kWater), static_cast<double>(three.transmitted), 1e-11);
}

TEST(NestedMedia, FiltersLightOfSurfacesInsideBody) {
  for (const char* technique : {"whitted", "distributed"}) {
    Json ink = scene({layer(0, 2, 5, "ink"), layer(0.5, 1, 4, "white")}, {{"ink", fog({0.25, 1, 1})}});
    ink["materials"]["white"] = {{"type", "rough"}, {"kd", {0.8, 0.8, 0.8}}};
    ink["ambient"] = {1, 1, 1};
    RenderRequest request = deep(5);
    request.technique = technique;
    const Vec3d seen = Tracing(ink, request).trace(Ray<double>{{0, 0, 5}, {0, 0, -1}}).radiance;
    EXPECT_LE(length(seen - Vec3d(0.2, 0.8, 0.8)), 1e-9) << technique;
  }
}

// Up to MediaList::kMax bodies around a point are exact. More are bounded in memory and finite.
TEST(NestedMedia, ListsSixteenBodies) {
  const auto seen = [](int count) {
    Json objects = Json::array(), materials = Json::object();
    for (int i = 0; i < count; ++i) {
      const std::string name = "m" + std::to_string(i);
      objects.push_back(layer(-10 + 0.0625 * i, 10 - 0.0625 * i, 50 - 0.1 * i, name.c_str()));
      materials[name] = fog(Vec3d(i % 2 == 0 ? 0.99 : 0.98, 1, 1));
    }
    return Tracing(scene(objects, materials), deep(5)).trace(Ray<double>{{0, 0, 20}, {0, 0, -1}}).radiance.x;
  };
  double right = 1;
  for (int i = 0; i < 16; ++i) {
    const double thickness = i < 15 ? 0.125 : 20 - 0.125 * 15;
    right *= std::pow(i % 2 == 0 ? 0.99 : 0.98, thickness);
  }
  EXPECT_NEAR(seen(16), right, 1e-9);
  const double many = seen(100);
  EXPECT_GT(many, 0.5);
  EXPECT_LE(many, 1);
}

// A pair of nested balls below an opaque floor makes the plan follow media. Nothing else is nested.
TEST(NestedMedia, KeepsBytesOfOtherScenes) {
  for (const char* name : {"material-refractive", "glass", "material-glass"})
    for (const char* technique : {"whitted", "distributed", "path"}) {
      // Rough glass multiplies its factors in another order if media are followed.
      if (name == std::string_view("material-glass") && technique != std::string_view("whitted")) continue;
      const Json alone = sample(name);
      Json beside = alone;
      beside["materials"]["below"] = kGlass;
      beside["objects"].push_back(ball({0, -5, 0}, 1, "below"));
      beside["objects"].push_back(ball({0, -5.1, 0}, 0.5, "below"));
      for (RenderRequest request : {in_float(size(48, 36)), in_double(size(48, 36))}) {
        request.technique = technique;
        request.samples = 1;
        request.max_depth = 6;
        request.reuse = 1;
        EXPECT_TRUE(identical(render(alone, request), render(beside, request))) << name << technique;
      }
    }
}

TEST(NestedMedia, KeepsOpenSurfacesUnchanged) {
  for (const char* shape : {"disk", "plane"}) {
    Json open = {{"type", shape}, {"normal", {0, 0, 1}}, {"material", "glass"}};
    open[shape[0] == 'd' ? "center" : "point"] = {0, 0, 0};
    if (shape[0] == 'd') open["radius"] = 1;
    const Json materials{{"glass", kGlass}};
    const Json alone = scene({open}, materials);
    const Json beside =
        scene({open, ball({50, 0, 9}, 1, "glass"), ball({50, 0.1, 9}, 0.5, "glass")}, materials);
    for (const double toward : {-1.0, 1.0}) {
      Tracing one(alone, deep(3)), two(beside, deep(3));
      const Ray<double> ray{{0.1, 0.2, -3 * toward}, safe_normalize(Vec3d(0.1, 0.2, toward))};
      EXPECT_EQ(one.trace(ray).radiance, two.trace(ray).radiance) << shape << toward;
    }
  }
}

TEST(NestedMedia, LeavesHalfSpaceOfWaterFromBelow) {
  Json pool = scene({{{"type", "plane"}, {"point", {0, 0, 0}}, {"normal", {0, 0, 1}}, {"material", "water"}},
                     ball({0, 0, -3}, 1, "glass")},
                    {{"water", kWater}, {"glass", kGlass}});
  Tracing up(pool, deep(1));
  up.trace(Ray<double>{{5, 0, -1}, {0.5, 0, std::sqrt(0.75)}});
  EXPECT_TRUE(has_angle(up, 180 - std::asin(1.33 * 0.5) / kRadians));
  Tracing down(pool, deep(1));
  down.trace(Ray<double>{{0.5, 0, -1}, {0, 0, -1}});
  const double out = std::asin(1.33 / 1.5 * 0.5) / kRadians;
  EXPECT_TRUE(has_angle(down, out - 30) || has_angle(down, 30 - out)) << "from water into glass";
}

TEST(NestedMedia, FollowsInstancesAndMotion) {
  Json alone = scene_with(Json::array(),
                          {{"materials", {{"white", {{"type", "rough"}, {"kd", 0.8}}}, {"glass", kGlass}}},
                           {"background", {0.3, 0.5, 0.8}},
                           {"ambient", {1, 1, 1}}});
  alone["objects"] = {layer(-3, -2.9, 0.5, "white")};
  alone["models"]["lens"]["objects"] = {ball({0, 0, 0}, 1, "glass")};
  alone["instances"] = {{{"model", "lens"}, {"scale", {1, 0.8, -0.6}}, {"rotate", {{"degrees", 30}}}}};
  for (const bool moves : {false, true}) {
    if (moves)
      alone["instances"][0]["motion"] = {{{"time", 0}, {"translate", {0, 0, 0}}},
                                         {{"time", 1}, {"translate", {0.5, 0, 0}}}};
    Json nested = alone;
    nested["models"]["lens"]["objects"].push_back(ball({0.1, 0, 0}, 0.6, "glass"));
    RenderRequest request = in_double(size(24, 24));
    request.samples = 4;
    request.max_depth = 5;
    if (moves) request.shutter = 1;
    EXPECT_LE(largest_difference(render(alone, request), render(nested, request)), 1e-6) << moves;
  }
}

TEST(NestedMedia, FollowsMeshesOnlyIfWatertight) {
  const auto tetrahedron = [](bool closed) {
    Json faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};
    if (closed) faces.push_back({1, 2, 3});
    return Json{{"type", "mesh"},
                {"positions", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                {"indices", faces},
                {"material", "glass"}};
  };
  for (const bool closed : {true, false}) {
    const auto loaded =
        load(scene({tetrahedron(closed), ball({0.1, 0.1, 0.1}, 0.05, "glass")}, {{"glass", kGlass}}));
    EXPECT_EQ(loaded->media.nested(), closed);
  }
}

TEST(NestedMedia, ExplainsWhetherMediaAreFollowed) {
  const auto choice = [](const Json& objects) {
    const auto loaded = load(scene(objects, {{"glass", kGlass}, {"ink", fog(Vec3d(0.5))}}));
    for (const Decision& decision : make_plan(*loaded, {}).decisions)
      if (decision.subject == "nested media") return decision.choice;
    return std::string("no decision");
  };
  EXPECT_EQ(choice({ball({0, 0, 0}, 1, "glass"), ball({3, 0, 0}, 1, "glass")}), "none");
  EXPECT_EQ(choice({ball({0, 0, 0}, 1, "glass"), ball({0, 0, 0}, 0.5, "white")}), "none");
  EXPECT_EQ(choice({ball({0, 0, 0}, 1, "ink"), ball({0, 0, 0}, 0.5, "white")}), "followed");
  EXPECT_EQ(choice({ball({0, 0, 0}, 1, "glass"), ball({1, 0, 0}, 1, "glass")}), "followed");
  EXPECT_EQ(choice({ball({0, 0, 4}, 1, "glass"), ball({1, 0, 4}, 1, "glass")}), "followed from the eye");
  EXPECT_EQ(choice({ball({0, 0, 0}, 1, "white")}), "no decision");
}

}  // namespace
}  // namespace orrery::test
