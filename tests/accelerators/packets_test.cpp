#include <gtest/gtest.h>

#include "tests/support/agreement.h"
#include "tests/support/random.h"

// Tests packet traversal of coherent rays.
namespace orrery::test {
namespace {

// Returns a bundle of `count` straws. A straw is a rectangle of two triangles, 2 m long and 1 mm wide.
Json straws(int count) {
  Random random(3);
  Json positions = Json::array(), indices = Json::array();
  for (int i = 0; i < count; ++i) {
    const Vec3d middle = random.in_cube(0.4),
                along = safe_normalize(Vec3d(1, 0.2, 0.1) + random.in_cube(0.3)),
                across = safe_normalize(cross(along, random.direction())) * 5e-4;
    for (const Vec3d& corner :
         {middle - along - across, middle + along - across, middle + along + across, middle - along + across})
      positions.push_back(numbers(corner));
    indices.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    indices.push_back({4 * i, 4 * i + 2, 4 * i + 3});
  }
  return scene_with(Json{{"type", "mesh"}, {"positions", positions}, {"indices", indices}});
}

// Returns camera rays in blocks of 4 x 4 neighbouring pixels.
template <class T>
Rays<T> camera_rays() {
  constexpr int kSide = 64;
  const Vec3<T> eye(0, 0, 3);
  Rays<T> rays;
  for (int block = 0; block < kSide * kSide / 16; ++block)
    for (int i = 0; i < 16; ++i) {
      const int x = block % (kSide / 4) * 4 + i % 4, y = block / (kSide / 4) * 4 + i / 4;
      rays.push_back({eye, normalize(Vec3<T>(T(x - kSide / 2) / kSide, T(y - kSide / 2) / kSide, -1))});
    }
  return rays;
}

template <class T>
void expect_agreement() {
  const Json scene = straws(4000);
  Structure<T> tree(scene, "bvh"), list(scene, "list");
  const Rays<T> rays = camera_rays<T>();
  const auto found = tree.closest(rays), right = list.closest(rays);
  int differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    differ += found[i].primitive != right[i].primitive || found[i].t != right[i].t;
  EXPECT_EQ(differ, 0);
  EXPECT_EQ(tree.occluded(rays, T(2.9)), list.occluded(rays, T(2.9)));
}

// Returns a mesh whose tree exceeds the caches, so that the traversal for large trees is used.
Json rough_sea() {
  constexpr int kSide = 440;
  Random random(4);
  Json positions = Json::array(), indices = Json::array();
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x)
      positions.push_back({2.0 * x / kSide - 1, 2.0 * y / kSide - 1, random.in_cube(0.05).z});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int at = y * (kSide + 1) + x;
      indices.push_back({at, at + 1, at + kSide + 2});
      indices.push_back({at, at + kSide + 2, at + kSide + 1});
    }
  return scene_with(Json{{"type", "mesh"}, {"positions", positions}, {"indices", indices}});
}

TEST(LargeBvh, MatchesList) {
  const Json scene = rough_sea();
  Structure<float> tree(scene, "bvh"), list(scene, "list");
  ASSERT_GT(tree.facts().bytes, std::size_t{16} << 20);
  Rays<float> rays = camera_rays<float>();
  rays.resize(rays.size() / 2);
  Random random(5);
  for (int i = 0; i < 1024; ++i) {  // incoherent rays along the waves and through them
    const Vec3d from = random.in_cube(1), way = random.direction();
    rays.push_back({Vec3f(Vec3d(from.x, from.y, from.z * 0.05)), Vec3f(Vec3d(way.x, way.y, way.z * 0.3))});
  }
  const auto found = tree.closest(rays), right = list.closest(rays);
  int differ = 0, met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    met += right[i].met();
    differ += found[i].primitive != right[i].primitive || found[i].t != right[i].t;
  }
  EXPECT_GT(met, 1500);
  EXPECT_EQ(differ, 0);
  EXPECT_EQ(tree.occluded(rays, 0.2f), list.occluded(rays, 0.2f));
}

TEST(PacketTraversal, MatchesListBeyondPacketBudget) {
  expect_agreement<float>();
  expect_agreement<double>();
}

// A packet may test a thousand times as many primitives as a single ray. Shadow rays from the bundle to a
// light are an example: together they pass many straws, but each ray passes few.
TEST(PacketTraversal, SwitchesToSingleRaysWhenPacketsAreExpensive) {
  const Json scene = straws(4000);
  Structure<float> tree(scene, "bvh");
  const Rays<float> camera = camera_rays<float>();
  const auto hits = tree.closest(camera);
  Rays<float> shadows;
  for (std::size_t i = 0; i < camera.size(); ++i)
    if (hits[i].met()) {
      const Vec3f at = camera[i].at(hits[i].t * 0.999f);
      shadows.push_back({at, normalize(Vec3f(0.3f, 2, 0.5f) - at)});
    }
  ASSERT_GT(shadows.size(), 500u);
  Rays<float> mixed;  // the same rays in an incoherent order
  for (std::size_t i = 0; i < shadows.size(); ++i) mixed.push_back(shadows[i * 389 % shadows.size()]);
  const auto tests_of = [&](const Rays<float>& rays) {
    Structure<float> fresh(scene, "bvh");
    fresh.occluded(rays, 3);
    return static_cast<double>(fresh.counts().primitive_tests);
  };
  EXPECT_LE(tests_of(shadows), 4 * tests_of(mixed));
}

}  // namespace
}  // namespace orrery::test
