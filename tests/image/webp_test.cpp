#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cmath>

#include "core/base/error.h"
#include "core/image/decode/picture.h"
#include "tests/support/errors.h"

// Encodes with libwebp.
namespace orrery::test {
namespace {

using ::testing::HasSubstr;

// sRGB codes of an image with 3 or 4 channels.
struct Codes {
  int width, height, channels;
  std::vector<std::uint8_t> values;
};

// Returns an image whose channels differ, smooth or with noise. Alpha is 100.
Codes pattern(int width, int height, int channels, bool noise = false) {
  Codes codes{width, height, channels, {}};
  std::uint32_t random = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        random = random * 1664525u + 1013904223u;
        const int smooth = 40 + (c == 0 ? 150 * x / width : c == 1 ? 150 * y / height : 90);
        codes.values.push_back(static_cast<std::uint8_t>(c == 3 ? 100 : noise ? random >> 24 : smooth));
      }
  return codes;
}

std::string webp_of(const Codes& codes, bool lossless) {
  std::uint8_t* bytes = nullptr;
  const int stride = codes.width * codes.channels;
  const auto of = [&](auto rgb, auto rgba, auto... quality) {
    return (codes.channels == 3 ? rgb : rgba)(codes.values.data(), codes.width, codes.height, stride,
                                              quality..., &bytes);
  };
  const std::size_t size =
      lossless ? of(WebPEncodeLosslessRGB, WebPEncodeLosslessRGBA) : of(WebPEncodeRGB, WebPEncodeRGBA, 90.0f);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return file;
}

std::string webp_refusal(const std::string& bytes) {
  return detail_of([&] { read_picture(bytes); });
}

double light_of(std::uint8_t code) {
  const double x = code / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

TEST(WebP, ReadsLossyAndLosslessFiles) {
  for (const int channels : {3, 4})
    for (const bool lossless : {false, true}) {
      const Codes codes = pattern(61, 37, channels);
      const Texels read = read_picture(webp_of(codes, lossless));
      ASSERT_EQ(read.width, 61);
      ASSERT_EQ(read.height, 37);
      EXPECT_TRUE(read.from_srgb);
      for (std::size_t i = 0; i < read.rgb.size(); ++i) {
        const std::uint8_t code = codes.values[i / 3 * static_cast<std::size_t>(channels) + i % 3];
        ASSERT_NEAR(read.rgb[i], light_of(code), lossless ? 1e-7 : 0.05) << channels << ' ' << lossless;
      }
    }
}

// The memory of the decoder is limited by the image size.
TEST(WebP, ReadsLargeFiles) {
  for (const int channels : {3, 4})
    for (const bool lossless : {false, true})
      EXPECT_EQ(read_picture(webp_of(pattern(1500, 700, channels, true), lossless)).width, 1500);
}

TEST(WebP, RejectsDamagedFiles) {
  for (const bool lossless : {false, true}) {
    const std::string file = webp_of(pattern(64, 64, 3, true), lossless);
    for (const double share : {0.005, 0.3, 0.6, 0.95})
      EXPECT_NE(
          webp_refusal(file.substr(0, static_cast<std::size_t>(share * static_cast<double>(file.size())))),
          "accepted")
          << share;
  }
  EXPECT_FALSE(is_picture("RIFF\4\0\0\0WAVE"));
}

TEST(WebP, RejectsAnimations) {
  const std::string header("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\2\0\0\0\7\0\0\7\0\0", 30);
  EXPECT_EQ(webp_refusal(header), "WebP: must be a still image (got an animation)");
}

TEST(WebP, ChecksHeaderSizesBeforeDecoding) {
  std::string lossy = webp_of(pattern(8, 8, 3), false);
  lossy[27] = lossy[29] = '\x3f';  // high bytes of width and height
  EXPECT_THAT(webp_refusal(lossy), HasSubstr("WebP: image has 16136 x 16136 texels (limits"));
  std::string lossless = webp_of(pattern(8, 8, 3), true);
  for (std::size_t i = 21; i < 25; ++i) lossless[i] = '\xff';
  EXPECT_THAT(webp_refusal(lossless), HasSubstr("WebP: image has 16384 x 16384 texels (limits"));
  lossy = webp_of(pattern(8, 8, 3), false);
  lossy[23] = 0;
  EXPECT_EQ(webp_refusal(lossy), "WebP: damaged at byte 20: image must begin with a key frame");
}

}  // namespace
}  // namespace orrery::test
