#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/image/image.h"
#include "core/image/srgb.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

// Returns the 8-bit sRGB codes of linear values.
std::vector<int> codes_of(const std::vector<float>& values) {
  constexpr int kRow = 4096;
  struct alignas(64) Row {
    std::array<float, kRow> values;
  };
  const auto row = std::make_unique<Row>();
  std::vector<int> codes;
  for (std::size_t from = 0; from < values.size(); from += kRow) {
    const std::size_t count = std::min<std::size_t>(kRow, values.size() - from);
    row->values.fill(0);
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), count, row->values.begin());
    Image image(static_cast<int>(count), 1, PixelFormat::srgb8);
    image.set_row(0, 0, static_cast<int>(count), row->values.data(), row->values.data(), row->values.data());
    for (std::size_t i = 0; i < count; ++i) {
      codes.push_back(static_cast<int>(image.bytes()[3 * i]));
      EXPECT_EQ(image.bytes()[3 * i + 1], image.bytes()[3 * i]);
      EXPECT_EQ(image.bytes()[3 * i + 2], image.bytes()[3 * i]);
    }
  }
  return codes;
}

// Returns the sRGB encoding of a linear value (IEC 61966-2-1).
long double encoded(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}

TEST(Srgb, RoundsToNearestCodeOfStandardCurve) {
  std::vector<float> values;
  for (int i = 0; i <= 1'000'000; ++i) values.push_back(static_cast<float>(i) * 1e-6f);
  test::Random random(1);
  for (int i = 0; i < 500'000; ++i) values.push_back(static_cast<float>(random.magnitude(1e-6, 1)));
  // All floats around the end of the linear segment.
  for (float x = 0.003f; x < 0.0033f; x = std::nextafter(x, 1.0f)) values.push_back(x);
  const std::vector<int> codes = codes_of(values);
  int wrong = 0, doubtful = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const long double exact = 255 * encoded(static_cast<long double>(values[i]));
    const long double to_boundary = std::abs(exact - std::floor(exact) - 0.5L);
    if (to_boundary < 0.002L)
      ++doubtful;
    else
      wrong += codes[i] != static_cast<int>(std::floor(exact + 0.5L));
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(doubtful, static_cast<int>(values.size()) / 100);
}

TEST(Srgb, EncodesMonotonically) {
  std::vector<float> values;
  for (float x = 1e-6f; x < 1.2f; x *= 1.00001f) values.push_back(x);
  const std::vector<int> codes = codes_of(values);
  for (std::size_t i = 1; i < codes.size(); ++i) ASSERT_LE(codes[i - 1], codes[i]) << values[i];
  EXPECT_EQ(codes.front(), 0);
  EXPECT_EQ(codes.back(), 255);
}

TEST(Srgb, ClampsOutOfRangeValues) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(codes_of({-1, -infinity, -0.0f, std::nanf("")}), (std::vector<int>{0, 0, 0, 0}));
  EXPECT_EQ(codes_of({1, 1.00001f, 2, 1e30f, infinity}), (std::vector<int>{255, 255, 255, 255, 255}));
}

TEST(Srgb, RoundTripsEveryCode) {
  std::vector<float> values;
  for (int code = 0; code < 256; ++code) values.push_back(decode_srgb(static_cast<float>(code) / 255));
  const std::vector<int> codes = codes_of(values);
  for (int code = 0; code < 256; ++code) EXPECT_EQ(codes[static_cast<std::size_t>(code)], code);
}

// Writes rows of 1 to 33 pixels at columns 0 to 19, in both formats. No other pixel may change.
TEST(Image, WritesOnlyPixelsOfRow) {
  struct alignas(64) Row {
    std::array<float, 64> values;
  } red, green, blue;
  for (std::size_t i = 0; i < 64; ++i) {
    red.values[i] = static_cast<float>(i) / 64;
    green.values[i] = 1;
    blue.values[i] = 0;
  }
  for (const PixelFormat format : {PixelFormat::srgb8, PixelFormat::linear32})
    for (int x = 0; x < 20; ++x)
      for (int count = 1; count <= 33; ++count) {
        Image image(60, 3, format);
        std::memset(image.bytes().data(), 0x55, image.bytes().size());
        image.set_row(x, 1, count, red.values.data(), green.values.data(), blue.values.data());
        const std::size_t from = image.row_bytes() + static_cast<std::size_t>(x) * image.pixel_bytes();
        const std::size_t to = from + static_cast<std::size_t>(count) * image.pixel_bytes();
        for (std::size_t i = 0; i < image.bytes().size(); ++i)
          if (i < from || i >= to) {
            ASSERT_EQ(image.bytes()[i], std::byte{0x55}) << x << " + " << count;
          }
        for (int i = 0; i < count; ++i) {
          EXPECT_NEAR(image.linear(x + i, 1).x, static_cast<float>(i) / 64,
                      format == PixelFormat::srgb8 ? 0.005f : 0);
          EXPECT_EQ(image.linear(x + i, 1).y, 1);
        }
      }
}

}  // namespace
}  // namespace orrery
