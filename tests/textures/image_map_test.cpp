#include "core/textures/image_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"

namespace orrery::test {
namespace {

Texels random_texels(int width, int height, std::uint64_t seed) {
  Random random(seed);
  Texels texels{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) texels.rgb.push_back(static_cast<float>(random.unit()));
  return texels;
}

Vec3d texel(const Texels& t, int column, int row) {
  const auto at = static_cast<std::size_t>((row * t.width + column) * 3);
  return {double{t.rgb[at]}, double{t.rgb[at + 1]}, double{t.rgb[at + 2]}};
}

TEST(ImagePyramid, ReturnsTexelsAtTheirCentres) {
  const Texels texels = random_texels(7, 5, 1);
  const ImagePyramid image(std::make_shared<const Texels>(texels), Wrap::repeat, Wrap::repeat);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 7; ++column) {
      const Vec3d found = image.at((column + 0.5) / 7, 1 - (row + 0.5) / 5, 0.0);
      EXPECT_LT(length(found - texel(texels, column, row)), 1e-14);
    }
}

TEST(ImagePyramid, InterpolatesBetweenTexels) {
  const Texels texels = random_texels(4, 4, 2);
  const ImagePyramid image(std::make_shared<const Texels>(texels), Wrap::clamp, Wrap::clamp);
  const Vec3d mean =
      (texel(texels, 1, 2) + texel(texels, 2, 2) + texel(texels, 1, 3) + texel(texels, 2, 3)) / 4;
  EXPECT_LT(length(image.at(0.5, 0.25, 0.0) - mean), 1e-15);
}

TEST(ImagePyramid, ContinuesImagesBeyondTheirEdges) {
  const Texels texels = random_texels(5, 3, 3);
  const auto shared = std::make_shared<const Texels>(texels);
  const ImagePyramid repeated(shared, Wrap::repeat, Wrap::repeat),
      mirrored(shared, Wrap::mirror, Wrap::mirror), clamped(shared, Wrap::clamp, Wrap::clamp);
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.unit(), v = random.unit();
    const Vec3d here = repeated.at(u, v, 0.0);
    EXPECT_LT(length(repeated.at(u + 3, v - 4, 0.0) - here), 1e-12);
    EXPECT_LT(length(mirrored.at(-u, v, 0.0) - mirrored.at(u, v, 0.0)), 1e-12);
    EXPECT_LT(length(mirrored.at(u + 2, 2 - v, 0.0) - mirrored.at(u, v, 0.0)), 1e-12);
    EXPECT_LT(length(clamped.at(1.5 + u, v, 0.0) - clamped.at(1.0, v, 0.0)), 1e-12);
  }
  EXPECT_LT(length(repeated.at(0.0, 0.5, 0.0) - (texel(texels, 0, 1) + texel(texels, 4, 1)) / 2), 1e-15);
  EXPECT_LT(length(mirrored.at(0.0, 0.5, 0.0) - texel(texels, 0, 1)), 1e-15);
}

TEST(ImagePyramid, KeepsTheMeanAtEveryLevel) {
  for (const auto& [width, height] : {std::pair{16, 16}, {13, 7}, {1, 9}, {31, 2}}) {
    const Texels texels = random_texels(width, height, 5);
    const ImagePyramid image(std::make_shared<const Texels>(texels), Wrap::repeat, Wrap::repeat);
    const auto mean = [](const auto& rgb) {
      double sum = 0;
      for (const float value : rgb) sum += double{value};
      return sum / static_cast<double>(rgb.size());
    };
    for (const auto& level : image.levels())
      EXPECT_NEAR(mean(*level.rgb), mean(texels.rgb), 1e-7) << level.width << " x " << level.height;
    EXPECT_EQ(image.levels().back().width, 1);
    EXPECT_EQ(image.levels().back().height, 1);
  }
}

TEST(ImagePyramid, HalvesLevelsByTheMeanOfFourTexels) {
  const Texels texels = random_texels(8, 8, 6);
  const ImagePyramid image(std::make_shared<const Texels>(texels), Wrap::repeat, Wrap::repeat);
  const Vec3d found = image.at(2.5 / 4, 1 - 1.5 / 4, 1.0);
  const Vec3d mean =
      (texel(texels, 4, 2) + texel(texels, 5, 2) + texel(texels, 4, 3) + texel(texels, 5, 3)) / 4;
  EXPECT_LT(length(found - mean), 1e-7);
}

TEST(ImagePyramid, InterpolatesBetweenLevels) {
  const Texels texels = random_texels(8, 8, 7);
  const ImagePyramid image(std::make_shared<const Texels>(texels), Wrap::repeat, Wrap::repeat);
  const Vec3d fine = image.at(0.3, 0.6, 1.0), coarse = image.at(0.3, 0.6, 2.0);
  EXPECT_LT(length(image.at(0.3, 0.6, 1.25) - (fine * 0.75 + coarse * 0.25)), 1e-14);
  EXPECT_LT(length(image.at(0.3, 0.6, 99.0) - image.at(0.1, 0.9, 3.0)), 1e-14);
}

TEST(ImagePyramid, IsFiniteFarFromTheOrigin) {
  const ImagePyramid image(std::make_shared<const Texels>(random_texels(5, 3, 8)), Wrap::mirror,
                           Wrap::mirror);
  for (const float u : {1e6f, -1e12f, 3e38f})
    for (const float level : {0.0f, 1.5f}) {
      const Vec3f found = image.at(u, -u, level);
      EXPECT_GE(found.x, 0);
      EXPECT_LE(found.x, 1);
    }
}

}  // namespace
}  // namespace orrery::test
