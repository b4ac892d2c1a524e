#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Compares every structure with the list, bit for bit, on adversarial scenes and the sample scenes.
namespace orrery::test {
namespace {

// Returns groups of 16 coherent rays, such as camera rays of neighbouring pixels or shadow rays to one light.
// The rays of a group have either a common origin or a common target, chosen at random.
template <class T>
Rays<T> alike_rays(const Vec3d& middle, double half, int count, double spread, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  while (static_cast<int>(rays.size()) < count) {
    const Vec3d target = middle + random.in_cube(half), eye = middle + random.direction() * (2.5 * half);
    const bool one_origin = random.below(2) == 0;
    for (int i = 0; i < 16; ++i) {
      const Vec3d other = target + random.in_cube(half * spread);
      const Vec3d from = one_origin ? eye : other, to = one_origin ? other : eye;
      rays.push_back({Vec3<T>(from), Vec3<T>(safe_normalize(to - from))});
    }
  }
  return rays;
}

template <class T>
Rays<T> any_rays(const Vec3d& middle, double half, int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back({Vec3<T>(middle + random.in_cube(1.5 * half)), Vec3<T>(random.direction())});
  return rays;
}

// Returns `count` rays in groups of 16. The rays of a group have a common origin, `from` metres away from a
// random target, and point towards random targets.
template <class T>
Rays<T> aimed_rays(const std::vector<Vec3d>& targets, double from, int count) {
  Random random(2);
  Rays<T> rays;
  while (static_cast<int>(rays.size()) < count) {
    const Vec3d eye = targets[static_cast<std::size_t>(random.below(static_cast<int>(targets.size())))] +
                      random.direction() * from;
    for (int i = 0; i < 16; ++i) {
      const Vec3d& target = targets[static_cast<std::size_t>(random.below(static_cast<int>(targets.size())))];
      rays.push_back({Vec3<T>(eye), Vec3<T>(safe_normalize(target - eye))});
    }
  }
  return rays;
}

class AdversarialScenes : public StructureTest {
 protected:
  template <class T>
  AcceleratorFacts agree(const Json& scene, const Rays<T>& rays) {
    return StructureTest::agree<T>(scene, rays, {T(0.7), std::numeric_limits<T>::infinity()});
  }
  // Compares the structure with the list, for `count` rays of each kind in a cube of half width `half`.
  AcceleratorFacts agree(const Json& scene, const Vec3d& middle, double half, int count) {
    const auto facts = agree<float>(scene, any_rays<float>(middle, half, count, 1));
    agree<double>(scene, any_rays<double>(middle, half, count, 1));
    for (const double spread : {1e-3, 0.03, 0.2}) {
      agree<float>(scene, alike_rays<float>(middle, half, count, spread, 2));
      agree<double>(scene, alike_rays<double>(middle, half, count, spread, 2));
    }
    return facts;
  }
};

Json sphere(const Vec3d& center, double radius) {
  return {{"type", "sphere"}, {"center", {center.x, center.y, center.z}}, {"radius", radius}};
}

// Returns a mesh of 2 * side * side triangles over [-1, 1]^2; z = height(x, y).
template <class Height>
Json sheet(int side, const Height& height) {
  Json positions = Json::array(), indices = Json::array();
  for (int row = 0; row <= side; ++row)
    for (int column = 0; column <= side; ++column) {
      const double x = 2.0 * column / side - 1, y = 2.0 * row / side - 1;
      positions.push_back({x, y, height(x, y)});
    }
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const int a = row * (side + 1) + column, b = a + 1, c = a + side + 1, d = c + 1;
      indices.push_back({a, b, c});
      indices.push_back({b, d, c});
    }
  return {{"type", "mesh"}, {"positions", positions}, {"indices", indices}};
}

TEST_P(AdversarialScenes, MatchesListOnWavySheet) {
  covers("F1");
  agree(scene_with({sheet(12, [](double x, double y) { return 0.3 * std::sin(5 * x) * std::cos(4 * y); })}),
        {}, 1.2, 20'000);
}

TEST_P(AdversarialScenes, MatchesListOnFlatSheet) {
  covers("F4");
  agree(scene_with({sheet(12, [](double, double) { return 0.0; })}), {}, 1.2, 20'000);
}

TEST_P(AdversarialScenes, MatchesListOnFewPrimitives) {
  covers("F4");
  for (int count = 1; count < 5; ++count) {
    Json objects = Json::array();
    for (int i = 0; i < count; ++i) objects.push_back(sphere(Vec3d(0.4 * i, 0, 0), 0.3));
    agree(scene_with(objects), {}, 1.5, 5'000);
  }
}

TEST_P(AdversarialScenes, BoundsDepthOnIdenticalTriangles) {
  covers("F2");
  Json indices = Json::array();
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) indices.push_back({0, 1, 2});
  const Json mesh = {
      {"type", "mesh"}, {"positions", {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}}, {"indices", indices}};
  const auto facts = agree<float>(scene_with({mesh}), any_rays<float>({}, 1.2, 200, 3));
  EXPECT_LE(facts.depth, 2 * std::log2(kCount) + 32);
}

TEST_P(AdversarialScenes, BoundsDepthOnConcentricSpheres) {
  covers("F2");
  Json objects = Json::array();
  for (int i = 0; i < 1000; ++i) objects.push_back(sphere({}, 0.001 * (i + 1)));
  EXPECT_LE(agree(scene_with(objects), {}, 1.2, 2'000).depth, 2 * std::log2(1000) + 32);
}

TEST_P(AdversarialScenes, MatchesListOnSpheresOfHalvingSize) {
  covers("F3");
  Json objects = Json::array();
  for (int i = -19; i < 37; ++i)
    objects.push_back(sphere(Vec3d(std::ldexp(1, -i), 0, 0), std::ldexp(0.25, -i)));
  for (const double half : {1e6, 1.0, 1e-6}) agree(scene_with(objects), {}, half, 10'000);
}

// With growing gaps, bottom-up grouping merges only one nearest pair per step.
TEST_P(AdversarialScenes, BoundsDepthOnGrowingGaps) {
  covers("F3");
  Json objects = Json::array();
  std::vector<Vec3d> centers;
  for (int i = 0; i < 3000; ++i) {
    const double size = std::exp2(-28.0 * i / 3000);
    centers.emplace_back(size, 0.001 * i, 0);
    objects.push_back(sphere(centers.back(), 1e-3 * size));
  }
  const Json scene = scene_with(objects);
  EXPECT_LE(agree<float>(scene, aimed_rays<float>(centers, 1.5, 5'000)).depth, 2 * std::log2(3000) + 32);
  agree<double>(scene, aimed_rays<double>(centers, 1.5, 5'000));
}

TEST_P(AdversarialScenes, MatchesListFarFromOrigin) {
  covers("F1");
  Random random(5);
  const Vec3d far(1e5, -3e4, 2e5);
  Json objects = Json::array();
  for (int i = 0; i < 200; ++i) objects.push_back(sphere(far + random.in_cube(10), random.between(0.1, 2)));
  agree(scene_with(objects), far, 12, 10'000);
}

TEST_P(AdversarialScenes, MatchesListOnSampleScenes) {
  covers("F1");
  for (const auto& entry : std::filesystem::directory_iterator("scenes")) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path());
    const Json scene = Json::parse(std::ifstream(entry.path()));
    const bool many = load(scene)->primitive_count() > 500;  // too slow for the list
    const int rays = !kSanitized ? 100'000 : many ? 100 : 10'000;
    agree<float>(scene, any_rays<float>({0, 1, 0}, 4, rays, 7));
    agree(scene, {0, 1, 0}, 4, !many ? 5'000 : kSanitized ? 100 : 1'000);
  }
}

INSTANTIATE_TEST_SUITE_P(All, AdversarialScenes, testing::ValuesIn(accelerator_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
