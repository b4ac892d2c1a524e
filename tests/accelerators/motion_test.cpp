#include <cmath>

#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

// Tests structures over moving geometry. Each frame refits the structure of the previous frame or builds a
// new one.
namespace orrery::test {
namespace {

// Grid of side * side positions for objects.
struct Square {
  int side, step;  // step * step = 1 modulo side * side, so partner_of(partner_of(i)) = i

  int size() const { return side * side; }
  Vec3d place_of(int i) const {
    return {2.0 * (i % side) - side, 0.3 * ((i * 7) % 5), 2.0 * (i / side) - side};
  }
  int partner_of(int i) const { return step * i % size(); }
};
constexpr Square kSquare{6, 17}, kLarge{20, 49};

// Returns instances that turn while they swap places in pairs within 1 s.
Json swapping_instances() {
  Json scene = scene_of(R"({"type": "sphere", "center": [0, -20, 0], "radius": 0.5})");
  const Json ball = {{"type", "sphere"}, {"center", {0.1, 0, 0}}, {"radius", 0.4}, {"material", "white"}};
  const Json rod = {{"type", "cylinder"},
                    {"base", {0, 0, 0}},
                    {"top", {0.6, 0.8, 0}},
                    {"radius", 0.1},
                    {"material", "white"}};
  scene["models"] = {{"it", {{"objects", {ball, rod}}}}};
  for (int i = 0; i < kSquare.size(); ++i)
    scene["instances"].push_back({{"model", "it"},
                                  {"translate", numbers(kSquare.place_of(i))},
                                  {"motion",
                                   {{{"time", 0}},
                                    {{"time", 1},
                                     {"translate", numbers(kSquare.place_of(kSquare.partner_of(i)))},
                                     {"degrees", 90 * i}}}}});
  return scene;
}

// Returns one mesh whose triangles swap places in pairs.
Json swapping_triangles(const Square& square = kSquare) {
  Json scene = scene_of(R"({"type": "sphere", "center": [0, -20, 0], "radius": 0.5})");
  Json mesh = {{"type", "mesh"}, {"material", "white"}};
  Json moved = Json::array();
  const std::array<Vec3d, 3> corners{Vec3d(-0.7, 0, 0), Vec3d(0.7, 0.2, 0.3), Vec3d(0, 0.1, -0.7)};
  for (int i = 0; i < square.size(); ++i) {
    for (const Vec3d& corner : corners) {
      mesh["positions"].push_back(numbers(square.place_of(i) + corner));
      moved.push_back(numbers(square.place_of(square.partner_of(i)) + corner));
    }
    mesh["indices"].push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh["motion"] = {{{"time", 0}}, {{"time", 1}, {"positions", moved}}};
  scene["objects"].push_back(mesh);
  return scene;
}

template <class T>
Rays<T> rays_through(double half, int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  while (static_cast<int>(rays.size()) < count) {
    const Vec3d from = random.in_cube(1.5 * half), to = random.in_cube(half);
    for (int i = 0; i < (random.below(2) ? 16 : 1); ++i)
      rays.push_back({Vec3<T>(from), Vec3<T>(safe_normalize(to + random.in_cube(0.05) - from))});
  }
  return rays;
}

struct UpdateCounts {
  int refitted = 0, built = 0;
  double worst = 1;
};

// For each frame, compares the updated structure and a newly built structure with the list at the same time.
template <class T>
UpdateCounts follow(const Json& json, const std::string& accelerator, int frames, int rays_a_frame,
                    double half = 7) {
  const auto scene = load(json);
  UpdateCounts followed;
  std::unique_ptr<Structure<T>> before;
  for (int frame = 0; frame <= frames; ++frame) {
    const double time = static_cast<double>(frame) / frames;
    auto now = std::make_unique<Structure<T>>(scene, accelerator, time, before.get());
    Structure<T> list(scene, "list", time), fresh(scene, accelerator, time);
    const auto rays = rays_through<T>(half, rays_a_frame, static_cast<std::uint64_t>(frame));
    expect_agreement(*now, list, rays, {T(0.7), T(3), T(1e30)});
    expect_agreement(fresh, list, rays, {T(3)});
    (now->facts().refitted ? followed.refitted : followed.built) += 1;
    followed.worst = std::max(followed.worst, now->facts().surface_area_growth);
    EXPECT_FALSE(fresh.facts().refitted);
    before = std::move(now);
  }
  return followed;
}

class Motion : public StructureTest {
 protected:
  // Expects hierarchies to be refitted while their surface area has grown by at most kMaxSurfaceAreaGrowth,
  // and rebuilt otherwise. All other structures are rebuilt for each frame.
  static void expect_both(const UpdateCounts& followed) {
    const bool hierarchy = GetParam() == "bottom-up" || GetParam() == "bvh";
    EXPECT_EQ(followed.refitted > 1, hierarchy);
    EXPECT_GT(followed.built, 1);
    EXPECT_LE(followed.worst, kMaxSurfaceAreaGrowth);
  }
};

TEST_P(Motion, RefitsOrRebuildsForSwappingInstances) {
  covers("F19 F1");
  const UpdateCounts followed = follow<float>(swapping_instances(), GetParam(), 20, 3000);
  follow<double>(swapping_instances(), GetParam(), 5, 1000);
  EXPECT_EQ(followed.refitted + followed.built, 21);
  expect_both(followed);
}

TEST_P(Motion, RefitsOrRebuildsForSwappingTriangles) {
  covers("F19 F1");
  const UpdateCounts followed = follow<float>(swapping_triangles(), GetParam(), 20, 3000);
  follow<double>(swapping_triangles(), GetParam(), 5, 1000);
  expect_both(followed);
}

// This mesh has enough triangles for inner nodes with inner children.
TEST_P(Motion, MatchesListOnLargeMovingMesh) {
  covers("F19 F1");
  Json scene = swapping_triangles(kLarge);
  scene["objects"][1]["motion"][1]["time"] = 16;
  follow<float>(scene, GetParam(), 4, 1000, 20);
  follow<double>(scene, GetParam(), 2, 1000, 20);
}

TEST_P(Motion, MatchesListWhenInstanceLeavesAndReturns) {
  covers("F19");
  Json scene = swapping_instances();
  for (Json& instance : scene["instances"]) instance.erase("motion");
  scene["instances"][7]["motion"] = {
      {{"time", 0}}, {{"time", 0.5}, {"translate", {3e4, 1e3, -2e4}}}, {{"time", 1}}};
  follow<float>(scene, GetParam(), 4, 2000);
}

// At 0.5 s, three triangles are collapsed to lines. At 1 s, the whole mesh is collapsed to a point.
TEST_P(Motion, MissesCollapsedTriangles) {
  covers("F19");
  Json scene = swapping_triangles();
  Json& mesh = scene["objects"][1];
  Json flat = mesh["positions"], point = mesh["positions"];
  for (std::size_t i = 0; i < 9; ++i)
    flat[i] = numbers(vector(flat[i - i % 3]) + Vec3d(0.1, 0, 0) * double(i % 3));
  for (auto& position : point) position = {1, 2, 3};
  mesh["motion"] = {{{"time", 0}}, {{"time", 0.5}, {"positions", flat}}, {{"time", 1}, {"positions", point}}};
  follow<float>(scene, GetParam(), 4, 2000);
  Structure<float> collapsed(load(scene), GetParam(), 1);
  Rays<float> rays;
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d from = random.in_cube(5);
    rays.push_back({Vec3f(from), Vec3f(safe_normalize(Vec3d(1, 2, 3) - from))});
  }
  for (const auto& hit : collapsed.closest(rays)) EXPECT_LE(hit.primitive, 0);  // the sphere is number 0
}

// Float rounding gives some of these collinear triangles an area, but no ray may hit them.
TEST_P(Motion, MissesTrianglesFlattenedToLines) {
  covers("F19");
  Random random(17);
  Json mesh = {{"type", "mesh"}, {"material", "white"}}, lines = Json::array();
  Rays<float> rays;
  for (int i = 0; i < 1000; ++i) {
    const auto exact = [&](double half) {  // multiples of 1/64, so that midpoints are exact
      const Vec3d v = random.in_cube(64 * half);
      return Vec3d(std::round(v.x), std::round(v.y), std::round(v.z)) / 64;
    };
    const Vec3d from = exact(1), along = exact(0.3);
    for (const double share : {0.0, 1.0, 0.5}) {
      lines.push_back(numbers(from + along * share));
      mesh["positions"].push_back(numbers(from + along * share + random.in_cube(0.1)));
    }
    mesh["indices"].push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (int k = 0; k < 20; ++k) {
      const Vec3d eye = random.in_cube(4), to = from + along * random.unit();
      rays.push_back({Vec3f(eye), Vec3f(safe_normalize(to - eye))});
    }
  }
  Json scene = scene_of(R"({'type': 'sphere', 'center': [0, -20, 0], 'radius': 0.5})");
  mesh["motion"] = {{{"time", 0}}, {{"time", 1}, {"positions", lines}}};
  scene["objects"].push_back(mesh);
  const auto loaded = load(scene);
  Structure<float> flat(loaded, GetParam(), 1), before(loaded, GetParam(), 0);
  int met = 0, met_before = 0;
  for (const auto& hit : flat.closest(rays)) met += hit.primitive > 0;
  for (const auto& hit : before.closest(rays)) met_before += hit.primitive > 0;
  EXPECT_EQ(met, 0);
  EXPECT_GT(met_before, 1000);
}

INSTANTIATE_TEST_SUITE_P(All, Motion, testing::ValuesIn(accelerator_names()), parameter_name);

TEST(MovingGeometry, SharesStaticGeometry) {
  Json json = swapping_instances();
  json["models"]["other"] = json["models"]["it"];
  json["models"]["other"]["objects"].push_back(swapping_triangles()["objects"][1]);
  json["instances"][3]["model"] = "other";
  const auto scene = load(json);
  const Structure<float> first(scene, "bvh", 0), second(scene, "bvh", 0.25, &first);
  EXPECT_EQ(first.geometry().shapes[0], second.geometry().shapes[0]);  // the sphere
  EXPECT_NE(first.geometry().shapes[1], second.geometry().shapes[1]);  // the instances
  EXPECT_EQ(first.geometry().models[0], second.geometry().models[0]);
  EXPECT_NE(first.geometry().models[1], second.geometry().models[1]);
}

// A tree built over coincident triangles must be rebuilt once they spread out.
TEST(MovingGeometry, RebuildsTreeOfFormerlyCoincidentTriangles) {
  covers("F19");
  Random random(4);
  Json mesh = {{"type", "mesh"}, {"material", "white"}}, apart = Json::array();
  for (int i = 0; i < 4000; ++i) {
    const Vec3d place = random.in_cube(40);
    for (const Vec3d& corner : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)}) {
      mesh["positions"].push_back(numbers(corner));
      apart.push_back(numbers(place + corner));
    }
    mesh["indices"].push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh["motion"] = {{{"time", 0}}, {{"time", 1}, {"positions", apart}}};
  const auto scene = load(scene_with(mesh));
  const auto rays = rays_through<float>(40, 2000, 5);
  for (const char* accelerator : {"bottom-up", "bvh"}) {
    Structure<float> together(scene, accelerator, 0), followed(scene, accelerator, 0.9, &together),
        fresh(scene, accelerator, 0.9);
    expect_agreement(followed, fresh, rays, {1e30f});
    EXPECT_LT(followed.counts().primitive_tests, 2 * fresh.counts().primitive_tests);
  }
}

}  // namespace
}  // namespace orrery::test
