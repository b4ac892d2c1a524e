#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Compares every registered structure with the list, which tests every primitive. Nearest primitives,
// distances (bit for bit) and shadows must be equal.
namespace orrery::test {
namespace {

// Returns `count` copies of every registered shape in a cube of half width 8. `bounded_only` leaves out
// planes and infinite cylinders.
Json cloud(int count, std::uint64_t seed, bool bounded_only = false) {
  Random random(seed);
  Json objects = Json::array();
  for (int i = 0; i < count; ++i)
    for (const std::string& type : shape_names())
      for (const Json& object : shape_samples(type)) {
        if (bounded_only && (type == "plane" || object.contains("axis"))) continue;
        objects.push_back(placed(object, random.magnitude(0.01, 1), random.in_cube(8)));
      }
  return scene_with(objects);
}

// Returns coplanar, touching and coincident shapes. Their hits are equally or nearly equally distant.
Json stack() {
  Json objects = Json::array();
  for (int i = 0; i < 6; ++i) {
    const double z = 0.3 * i;
    objects.push_back({{"type", "box"}, {"min", {-1, -1, z}}, {"max", {1, 1, z + 0.3}}});
    objects.push_back({{"type", "disk"}, {"center", {0, 0, z}}, {"normal", {0, 0, 1}}, {"radius", 1}});
    objects.push_back({{"type", "triangle"}, {"vertices", {{-1, -1, z}, {1, -1, z}, {0, 1, z}}}});
    objects.push_back({{"type", "triangle"}, {"vertices", {{-0.9, -1, z}, {0.7, -1, z}, {0.1, 1, z}}}});
    objects.push_back({{"type", "cylinder"}, {"base", {0, 0, z}}, {"top", {0, 0, z + 0.3}}, {"radius", 1}});
    objects.push_back({{"type", "sphere"}, {"center", {0, 0, z}}, {"radius", 0.3}});
  }
  return scene_with(objects);
}

template <class T>
Rays<T> rays_through(double half, double from, int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3d at = random.in_cube(half);
    Vec3d direction = random.direction();
    if (i % 4 == 1) direction = Vec3d(0, 0, random.below(2) ? 1 : -1);
    if (i % 4 == 2)
      direction = safe_normalize(Vec3d(1, 0, 0) + random.direction() * random.magnitude(1e-6, 1e-2));
    rays.push_back({Vec3<T>(at - direction * random.between(0, from)), Vec3<T>(direction)});
  }
  return rays;
}

// Returns rays that start `distance` away and pass within 8 ulp of `distance` of the surface, where rounding
// decides. Most rays are tangential. Every fourth ray has a random direction, because tangential rays miss
// flat shapes.
template <class T>
Rays<T> touching_rays(const Json& object, double distance, int count) {
  const Target<double> shape(scene_with(object));
  const Rays<double> probes = rays_at<double>(object, {1, Vec3d()}, count, 4);
  const auto hits = shape.closest(probes);
  const auto spots = shape.surfaces(probes, hits);
  const double rounding = distance * static_cast<double>(std::numeric_limits<T>::epsilon());
  Random random(4);
  Rays<T> rays;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!hits[i].met()) continue;
    const Vec3d other = random.direction();
    const Vec3d along = i % 4 == 0 ? other : safe_normalize(cross(spots[i].geometric, other));
    const Vec3d near = spots[i].position + spots[i].outward() * (random.between(-8, 8) * rounding);
    rays.push_back({Vec3<T>(near - along * distance), Vec3<T>(along)});
  }
  return rays;
}

class Accelerators : public StructureTest {
 protected:
  template <class T>
  void agree(const Json& scene, const Rays<T>& rays) {
    StructureTest::agree<T>(scene, rays, {T(0.5), T(20), std::numeric_limits<T>::infinity()});
  }
  template <class T>
  void agree(const Json& scene, double half, double from, int count) {
    agree<T>(scene, rays_through<T>(half, from, count, 3));
  }
};

TEST_P(Accelerators, MatchesListOnRandomShapes) {
  covers("F1 F5");
  agree<float>(cloud(20, 1), 8, 30, 100'000);
  agree<double>(cloud(20, 1), 8, 30, 100'000);
  agree<float>(cloud(20, 2, true), 8, 30, 50'000);
}

TEST_P(Accelerators, MatchesListOnCoincidentSurfaces) {
  covers("F1");
  for (const double from : {2.0, 100.0, 3000.0}) {
    agree<float>(stack(), 1.2, from, 100'000);
    agree<double>(stack(), 1.2, from, 100'000);
  }
}

// For a ray that grazes a distant silhouette, the kernel's result depends on rounding. A box test must not
// reject a ray that the kernel accepts.
TEST_P(Accelerators, MatchesListOnDistantRays) {
  covers("F1");
  const int rays = exhaustive() ? 10'000 : 3'000;
  for (const std::string& type : shape_names())
    for (const Json& object : shape_samples(type)) {
      SCOPED_TRACE(object.dump());
      const Json scene = scene_with(object);
      for (const double from : {10.0, 1e3, 1e5}) {
        agree<float>(scene, touching_rays<float>(object, from, rays));
        agree<double>(scene, touching_rays<double>(object, from, rays));
      }
    }
}

TEST_P(Accelerators, MatchesListOnGrazingRays) {
  covers("F1");
  for (const std::string& type : shape_names())
    for (const Json& object : shape_samples(type)) {
      SCOPED_TRACE(object.dump());
      agree<float>(scene_with(object), rays_at<float>(object, {1, Vec3d()}, 20'000, 8));
      agree<double>(scene_with(object), rays_at<double>(object, {1, Vec3d()}, 20'000, 8));
    }
}

// Rays exactly along an axis may cost at most three times as many tests and node visits as jittered rays.
TEST_P(Accelerators, BoundsCostOfAxisAlignedRays) {
  covers("A29");
  const auto work = [&](double jitter) {
    Structure<float> structure(cloud(20, 5, true), GetParam());
    Random random(6);
    Rays<float> rays;
    for (int i = 0; i < 20'000; ++i)
      rays.push_back(
          {Vec3f(static_cast<float>(random.between(-8, 8)), static_cast<float>(random.between(-8, 8)), -20),
           Vec3f(safe_normalize(Vec3d(0, 0, 1) + random.direction() * jitter))});
    structure.closest(rays);
    return static_cast<double>(structure.counts().primitive_tests + structure.counts().box_tests);
  };
  EXPECT_LE(work(0), 3 * work(1e-3));
}

TEST_P(Accelerators, ReturnsNoHitForNanRays) {
  covers("A36");
  Structure<float> structure(cloud(2, 7), GetParam());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Rays<float> rays = {
      {{nan, 0, 0}, {0, 0, 1}}, {{0, 0, -20}, {nan, nan, nan}}, {{nan, nan, nan}, {nan, 1, 0}}};
  for (const auto& hit : structure.closest(rays)) EXPECT_FALSE(hit.met());
}

INSTANTIATE_TEST_SUITE_P(All, Accelerators, testing::ValuesIn(accelerator_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
