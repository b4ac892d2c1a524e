#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests symmetries of path tracing, which need no reference values.
namespace orrery::test {
namespace {

Json with_twice_the_light(Json scene) {
  const auto twice = [](Json& color) {
    for (Json& channel : color) channel = 2 * channel.get<double>();
  };
  Json none = Json::array();
  for (Json& light : scene.contains("lights") ? scene["lights"] : none) {
    const char* key = light["type"] == "line" ? "intensity_per_metre" : "intensity";
    twice(light[key] = light.value(key, json("[1, 1, 1]")));
  }
  for (Json& material : scene["materials"])
    if (material.contains("emission")) twice(material["emission"]);
  if (scene.contains("background")) twice(scene["background"]);
  return scene;
}

TEST(PathSymmetry, DoublesImageWithDoubledLight) {
  covers("R31 light-52");
  for (const char* name : {"lamps", "cornell-box", "material-glass", "light-line"}) {
    RenderRequest request = size(64, 40);
    request.samples = 4;
    const Picture once = render(sample(name), request),
                  twice = render(with_twice_the_light(sample(name)), request);
    int wrong = 0;
    for (std::size_t i = 0; i < once.pixels.size(); ++i) wrong += twice.pixels[i] != once.pixels[i] * 2;
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_GT(once.sum(), 0) << name;
  }
}

constexpr int kSeeds = 8, kBlock = 16, kAcross = 5, kDown = 3;

// Means of pixel blocks over images of several seeds.
struct Blocks {
  std::array<double, kAcross * kDown> mean{}, variance{};  // variance of the mean
};
Blocks blocks_of(const Json& scene, std::uint64_t first_seed, bool from_the_right = false) {
  const auto loaded = load(scene);
  Blocks blocks;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    RenderRequest request = size(kBlock * kAcross, kBlock * kDown);
    request.samples = 16;
    request.seed = first_seed + seed;
    const Picture picture = render(loaded, request);
    std::array<double, kAcross * kDown> sums{};
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        sums[static_cast<std::size_t>(y / kBlock * kAcross + x / kBlock)] +=
            double{picture.at(from_the_right ? picture.width - 1 - x : x, y).y};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      blocks.mean[i] += sums[i] / kSeeds;
      blocks.variance[i] += sums[i] * sums[i] / kSeeds;
    }
  }
  for (std::size_t i = 0; i < blocks.mean.size(); ++i)
    blocks.variance[i] = (blocks.variance[i] - blocks.mean[i] * blocks.mean[i]) / (kSeeds - 1);
  return blocks;
}

// Expects differences below 6 standard errors (Welch). The mean square of the differences in standard errors
// must be near (n - 1) / (n - 3), the expectation for 2 (n - 1) degrees of freedom.
void expect_equal(const Blocks& a, const Blocks& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.mean.size(); ++i) {
    if (a.variance[i] + b.variance[i] == 0) {  // black block
      EXPECT_EQ(a.mean[i], b.mean[i]);
      continue;
    }
    const double t = (a.mean[i] - b.mean[i]) / std::sqrt(a.variance[i] + b.variance[i]);
    EXPECT_LT(std::abs(t), 6) << i << " " << a.mean[i] << " " << b.mean[i];
    squares += t * t / static_cast<double>(a.mean.size());
  }
  EXPECT_LT(squares, 3.5);
}

// With another order of lights, the same random numbers select other lights. The noise differs, but not the
// mean.
TEST(PathSymmetry, ChangesOnlyNoiseWithLightOrder) {
  covers("R31 light-52");
  const Json scene = sample("lamps");
  Json permuted = scene;
  std::reverse(permuted["lights"].begin(), permuted["lights"].end());
  std::reverse(permuted["objects"].begin(), permuted["objects"].end());
  expect_equal(blocks_of(scene, 0), blocks_of(permuted, 100));
}

TEST(PathSymmetry, MirrorsImageWithScene) {
  covers("R31 light-52");
  for (const char* name : {"lamps", "cornell-box"})
    expect_equal(blocks_of(sample(name), 0), blocks_of(mirrored(sample(name)), 100, true));
}

}  // namespace
}  // namespace orrery::test
