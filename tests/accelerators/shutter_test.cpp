#include <cmath>

#include "core/accelerators/exhaustive.h"
#include "core/accelerators/moving_instances.h"
#include "core/accelerators/registry.h"
#include "core/prepare/geometry.h"
#include "tests/support/batches.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/structures.h"

// Tests motion blur: each ray must hit moving geometry where it is at the time of the ray.
namespace orrery::test {
namespace {

const Exposure kExposure{0.1, 1.3};

// Returns a scene with static and moving instances and a plane in a tilting instance. Static and deforming
// meshes alternate. Some instances contain a deforming mesh. Keyframes are inside and outside the exposure.
Json busy_scene() {
  Random random(8);
  Json scene = scene_of(R"([
      {'type': 'sphere', 'center': [0, -3, 0], 'radius': 1.5}])");
  const auto swarm = [&](int count) {
    Json mesh = {{"type", "mesh"}, {"material", "white"}}, later = Json::array(), last = Json::array();
    for (int i = 0; i < count; ++i) {
      const Vec3d at = random.in_cube(4), to = random.in_cube(4), end = random.in_cube(4);
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3d off = random.in_cube(0.8);
        mesh["positions"].push_back(numbers(at + off));
        later.push_back(numbers(at * 0.7 + to * 0.3 + off));
        last.push_back(numbers(at * 0.7 + end * 0.3 + off));
      }
      mesh["indices"].push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    mesh["motion"] = {
        {{"time", 0}}, {{"time", 0.7}, {"positions", later}}, {{"time", 1.1}, {"positions", last}}};
    return mesh;
  };
  const auto resting = [](double y) {
    return Json{{"type", "mesh"},
                {"positions", {{-6, y, -6}, {6, y, -6}, {0, y, 6}, {2, y + 0.5, 3}}},
                {"indices", {{0, 1, 2}, {1, 2, 3}}},
                {"material", "white"}};
  };
  for (const Json& mesh : {swarm(3), resting(-2), swarm(60), resting(-1), swarm(2)})
    scene["objects"].push_back(mesh);
  const Json ball = {{"type", "sphere"}, {"center", {0.3, 0, 0}}, {"radius", 0.4}, {"material", "white"}};
  const Json rod = {{"type", "cylinder"},
                    {"base", {0, 0, 0}},
                    {"top", {0.6, 0.8, 0}},
                    {"radius", 0.1},
                    {"material", "white"}};
  const Json floor = {{"type", "plane"}, {"point", {0, -7, 0}}, {"normal", {0, 1, 0}}, {"material", "white"}};
  scene["models"] = {{"it", {{"objects", {ball, rod}}}},
                     {"swarm", {{"objects", {swarm(10), ball}}}},
                     {"floor", {{"objects", {floor}}}}};
  for (int i = 0; i < 40; ++i) {
    Json instance = {{"model", i % 5 == 0 ? "swarm" : "it"},
                     {"translate", numbers(random.in_cube(5))},
                     {"rotate", {{"axis", numbers(random.direction())}, {"degrees", 40 * i}}}};
    if (i % 3 != 0)
      instance["motion"] = {{{"time", -1}},
                            {{"time", 0.4}, {"translate", numbers(random.in_cube(5))}, {"degrees", 90 * i}},
                            {{"time", 2}, {"degrees", -700}, {"scale", {0.5 + 0.05 * i, 1, 2}}}};
    scene["instances"].push_back(instance);
  }
  scene["instances"].push_back({{"model", "floor"},
                                {"rotate", {{"axis", {1, 0, 0}}, {"degrees", 0}}},
                                {"motion", {{{"time", 0}}, {{"time", 1}, {"degrees", 20}}}}});
  return scene;
}

template <class T>
std::unique_ptr<RayBatch<T>> timed_rays(std::uint64_t seed) {
  Random random(seed);
  auto rays = std::make_unique<RayBatch<T>>();
  rays->count = kBatch;
  Vec3d from, to;
  for (int i = 0; i < kBatch; ++i) {
    if (i % 16 == 0) from = random.in_cube(8), to = random.in_cube(5);
    if (seed % 2 == 0) from = random.in_cube(8);
    const Vec3d at = to + random.in_cube(seed % 2 == 0 ? 5 : 0.3);
    rays->set(i, {Vec3<T>(from), Vec3<T>(safe_normalize(at - from))}, std::numeric_limits<T>::infinity());
    rays->time[i] = static_cast<T>(static_cast<float>(random.below(1 << 24)) * 0x1p-24f);
  }
  return rays;
}

const AcceleratorType& type_named(const std::string& name) {
  for (const auto& type : accelerator_types())
    if (name == type.name) return type;
  throw std::invalid_argument(name);
}

const LaneGroups& all_groups(float) {
  static const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<float>);
  return all;
}
const LaneGroups& all_groups(double) {
  static const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<double>);
  return all;
}

template <class T>
std::unique_ptr<HitBatch<T>> fresh_hits(const RayBatch<T>& rays) {
  auto hits = std::make_unique<HitBatch<T>>();
  hits->t = rays.t_max;
  hits->primitive.values.fill(kNoPrimitive);
  return hits;
}

class Shutter : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  void agrees_with_testing_everything() {
    const auto scene = load(busy_scene());
    const auto& type = type_named(GetParam());
    const auto geometry = make_geometry<T>(scene, type, kExposure);
    const AcceleratorPtr<T> structure = build_or_refit<T>(type, geometry->primitives, nullptr);
    AcceleratorCounts counts, of_list;
    int met = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const auto rays = timed_rays<T>(seed);
      const auto found = fresh_hits(*rays), expected = fresh_hits(*rays);
      structure->closest(*rays, all_groups(T()), *found, counts);
      closest_exhaustive(geometry->primitives, *rays, all_groups(T()), *expected, of_list);
      for (const T reach : {T(2), T(9)}) {
        const auto shadow = timed_rays<T>(seed), open = timed_rays<T>(seed);
        shadow->t_max.values.fill(reach);
        open->t_max.values.fill(reach);
        structure->occlude(*shadow, all_groups(T()), counts);
        occlude_exhaustive(geometry->primitives, *open, all_groups(T()), of_list);
        for (int i = 0; i < kBatch; ++i) ASSERT_EQ(shadow->t_max[i] < 0, open->t_max[i] < 0) << i;
      }
      for (int i = 0; i < kBatch; ++i) {
        ASSERT_EQ(found->primitive[i], expected->primitive[i]) << seed << ", " << i;
        ASSERT_EQ(found->t[i], expected->t[i]);
        met += found->primitive[i] >= 0;
      }
    }
    EXPECT_GT(met, 3 * kBatch);
    EXPECT_LT(counts.primitive_tests, of_list.primitive_tests);
  }
};

TEST_P(Shutter, MatchesExhaustiveSearchOnMovingGeometry) {
  covers("F19 F1");
  agrees_with_testing_everything<float>();
  agrees_with_testing_everything<double>();
}

INSTANTIATE_TEST_SUITE_P(All, Shutter, testing::ValuesIn(accelerator_names()), parameter_name);

// Hits and surfaces of rays at one time equal those of the scene at that instant.
TEST(MotionBlur, MatchesStillSceneAtRayTime) {
  covers("F19");
  const auto scene = load(busy_scene());
  const auto& type = type_named("bvh");
  const auto geometry = make_geometry<double>(scene, type, kExposure);
  const auto structure = build_or_refit<double>(type, geometry->primitives, nullptr);
  AcceleratorCounts counts;
  int met = 0, moved = 0;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 0x1.fffffep-1}) {
    const double time = kExposure.opens + share * (kExposure.closes - kExposure.opens);
    const auto standing = make_geometry<double>(scene, type, time);
    const auto still = build_or_refit<double>(type, standing->primitives, nullptr);
    for (const std::uint64_t seed : {0u, 1u, 2u}) {
      const auto rays = timed_rays<double>(seed);
      rays->time.values.fill(share);
      const auto found = fresh_hits(*rays), expected = fresh_hits(*rays);
      structure->closest(*rays, all_groups(1.0), *found, counts);
      still->closest(*rays, all_groups(1.0), *expected, counts);
      SurfaceBatch<double> surface, standing_surface;
      for (const auto& shapes : geometry->shapes) shapes->surface(*rays, *found, all_groups(1.0), surface);
      for (const auto& shapes : geometry->shapes) shapes->parameters(*rays, all_groups(1.0), *found, surface);
      for (const auto& shapes : standing->shapes)
        shapes->surface(*rays, *expected, all_groups(1.0), standing_surface);
      for (const auto& shapes : standing->shapes)
        shapes->parameters(*rays, all_groups(1.0), *expected, standing_surface);
      for (int i = 0; i < kBatch; ++i) {
        ASSERT_EQ(found->primitive[i], expected->primitive[i]) << share << ", " << i;
        if (found->primitive[i] < 0) continue;
        ++met;
        moved += found->primitive[i] > 1;
        ASSERT_NEAR(found->t[i], expected->t[i], 1e-9 * (1 + found->t[i]));
        ASSERT_LT(length(surface.position[i] - standing_surface.position[i]), 1e-9);
        ASSERT_LT(length(surface.geometric[i] - standing_surface.geometric[i]), 1e-9);
        ASSERT_LT(length(surface.normal[i] - standing_surface.normal[i]), 1e-9);
        ASSERT_LT(length(surface.tangent[i] - standing_surface.tangent[i]), 1e-7);
        ASSERT_NEAR(surface.u[i], standing_surface.u[i], 1e-9);
      }
    }
  }
  EXPECT_GT(met, 4000);
  EXPECT_GT(moved, 1000);
}

// Corners of rotating, growing and moving geometry stay in the box, and the box is not much larger than
// needed.
TEST(MotionBlur, BoundsRotatingGeometryTightly) {
  Random random(3);
  const Boundsd model = Boundsd::of({{-1, 0.5, -0.2}, {2, 0.7, 0.4}});
  for (int trial = 0; trial < 300; ++trial) {
    const double most = trial % 3 == 0 ? 3000 : trial % 3 == 1 ? 200 : 10;
    Instance instance{0, random.direction(), {}};
    for (const double time : {0.0, 1.0, 3.0}) {
      instance.motion.times.push_back(time);
      instance.motion.values.push_back(
          {{random.between(0.3, 2), random.between(0.3, 2), random.between(0.3, 2)},
           random.between(-most, most),
           random.in_cube(5)});
    }
    const Exposure exposure{random.between(-1, 1), random.between(1, 4)};
    const Boundsd box = bounds_during(model, instance, exposure);
    Boundsd needed;
    for (int i = 0; i <= 3000; ++i) {
      const Affined now =
          instance.world_from_model(exposure.opens + (exposure.closes - exposure.opens) * i / 3000);
      for (const Vec3d& corner : corners_of(model)) needed.include(now.point(corner));
    }
    EXPECT_TRUE(box.contains(needed.lo) && box.contains(needed.hi)) << trial;
    if (most < 100) {
      EXPECT_LT(box.diagonal(), 1.02 * needed.diagonal()) << trial;
    }
  }
}

// Static geometry is shared with the previous exposure or instant. The structure is refitted only after a
// previous exposure.
TEST(MotionBlur, ReusesStaticGeometryAcrossExposures) {
  const auto scene = load(busy_scene());
  const auto& type = type_named("bvh");
  const auto first = make_geometry<float>(scene, type, kExposure);
  const auto before = build_or_refit<float>(type, first->primitives, nullptr);
  const auto instant = make_geometry<float>(scene, type, 0.5, first.get());
  const auto between = build_or_refit<float>(type, instant->primitives, before.get());
  const Exposure later{0.6, 0.9};
  for (const Accelerator<float>* known : {before.get(), between.get()}) {
    const auto geometry =
        make_geometry<float>(scene, type, later, known == before.get() ? first.get() : instant.get());
    EXPECT_EQ(geometry->shapes[0], first->shapes[0]);  // the static sphere
    const auto followed = build_or_refit<float>(type, geometry->primitives, known);
    EXPECT_EQ(followed->facts().refitted, known == before.get());
    AcceleratorCounts counts;
    const auto rays = timed_rays<float>(5);
    const auto found = fresh_hits(*rays), expected = fresh_hits(*rays);
    followed->closest(*rays, all_groups(1.0f), *found, counts);
    closest_exhaustive(geometry->primitives, *rays, all_groups(1.0f), *expected, counts);
    for (int i = 0; i < kBatch; ++i) ASSERT_EQ(found->t[i], expected->t[i]);
  }
}

}  // namespace
}  // namespace orrery::test
