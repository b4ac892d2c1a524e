#include <gtest/gtest.h>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "core/plan/plan.h"
#include "core/prepare/settle.h"
#include "core/prepare/trial.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/stopped.h"

// Tests the automatic choice of a structure.
namespace orrery::test {
namespace {

Json ball(const Vec3d& center, double radius) {
  return {{"type", "sphere"}, {"center", numbers(center)}, {"radius", radius}};
}
Json triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {{"type", "triangle"}, {"vertices", {numbers(a), numbers(b), numbers(c)}}};
}

// Adds `count` balls at random places in a cube.
void add_cloud(Json& objects, int count, const Vec3d& middle, double half) {
  Random random(1);
  for (int i = 0; i < count; ++i)
    objects.push_back(ball(middle + random.in_cube(half), random.between(0.01, 0.04) * half));
}

// Adds a small, detailed cloud of balls inside a wide ring of large triangles.
void add_stadium(Json& objects, int count, const Vec3d& middle) {
  add_cloud(objects, count / 2, middle, 0.2);
  for (int i = 0; i < count / 2; ++i) {
    const double a = 4 * M_PI * i / count, b = 4 * M_PI * (i + 1) / count;
    const Vec3d low = middle + Vec3d(40 * std::cos(a), -5, 40 * std::sin(a));
    objects.push_back(
        triangle(low, middle + Vec3d(40 * std::cos(b), 9, 40 * std::sin(b)), low + Vec3d(0, 14, 0)));
  }
}

Json needles(int count) {
  Random random(2);
  Json objects = Json::array();
  for (int i = 0; i < count; ++i) {
    const Vec3d a = random.in_cube(1.2);
    objects.push_back(triangle(a, a + random.direction() * 1.5, a + random.direction() * 0.02));
  }
  return objects;
}

std::map<std::string, Json> scenes() {
  std::map<std::string, Json> scenes{{"few", sample("glass")},
                                     {"mirrors", sample("mirrors")},
                                     {"flake", sample("sphereflake-3")},
                                     {"needles", scene_with(needles(800))}};
  Json cloud = Json::array(), stadium = Json::array(), half = Json::array();
  add_cloud(cloud, 2500, {}, 1.5);
  add_stadium(stadium, 1500, {});
  add_cloud(half, 400, {-1.5, 0, 0}, 1);
  add_stadium(half, 400, {1.5, 0, 0});
  scenes["cloud"] = scene_with(cloud);
  scenes["stadium"] = scene_with(stadium);
  scenes["half cloud, half stadium"] = scene_with(half);
  for (const char* name : {"orrery", "instances"}) scenes[name] = sample(name);
  return scenes;
}

RenderRequest square(int side) {
  RenderRequest request;
  request.width = request.height = side;
  request.accelerator = "auto";
  return request;
}

double cost(const PreparedScene& scene, const Plan& plan, const AcceleratorType& type) {
  double build_ms = 0;
  const TraceCounts counts = try_tiles(world_for<float>(scene.parts(), type, plan.time, build_ms), plan, 6);
  return type.costs.of(counts.rays.total(), counts.accelerator);
}

TEST(Settle, ChoosesNearlyCheapestStructure) {
  covers("F16");
  for (const auto& [name, json] : scenes()) {
    SCOPED_TRACE(name);
    const PreparedScene scene(load(json));
    RenderRequest request = square(192);
    request.precision = Precision::single_precision;
    const SettledPlan plan = settle(scene, make_plan(scene.scene(), request));
    EXPECT_FALSE(plan->try_accelerators);
    double best = std::numeric_limits<double>::infinity();
    for (const auto& type : accelerator_types()) best = std::min(best, cost(scene, *plan, type));
    EXPECT_LE(cost(scene, *plan, *plan->accelerator), 1.25 * best) << plan->accelerator->name;
  }
}

TEST(Settle, KeepsChoiceWhileCameraMoves) {
  covers("F16");
  const PreparedScene scene(load(sample("glass")));
  std::set<std::string> chosen;
  for (const double azimuth : {0.0, 40.0, 90.0, 200.0}) {
    RenderRequest request = square(64);
    request.azimuth_degrees = azimuth;
    chosen.insert(settle(scene, make_plan(scene.scene(), request))->accelerator->name);
  }
  EXPECT_EQ(chosen.size(), 1u);
}

TEST(Settle, ReportsReasonForChoice) {
  const PreparedScene scene(load(sample("glass")));
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), {}));
  for (const Decision& decision : plan->decisions) {
    if (decision.subject != "accelerator") continue;
    EXPECT_EQ(decision.choice, plan->accelerator->name);
    EXPECT_NE(decision.reason.find("bvh"), std::string::npos) << decision.reason;
    EXPECT_NE(decision.reason.find("boxes"), std::string::npos) << decision.reason;
  }
}

TEST(Settle, StopsOnCancellation) {
  const PreparedScene scene(load(sample("glass")));
  EXPECT_THROW(settle(scene, make_plan(scene.scene(), {}), stopped()), Cancelled);
}

TEST(Settle, KeepsRequestedStructure) {
  const PreparedScene scene(load(sample("glass")));
  RenderRequest request;
  request.accelerator = "octree";
  EXPECT_STREQ(settle(scene, make_plan(scene.scene(), request))->accelerator->name, "octree");
}

}  // namespace
}  // namespace orrery::test
