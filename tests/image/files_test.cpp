#include "core/image/encode/files.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/base/error.h"
#include "tests/support/errors.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

Image noise(int width, int height) {
  Image image(width, height, PixelFormat::srgb8);
  test::Random random(1);
  for (std::byte& b : image.bytes()) b = static_cast<std::byte>(random.bits());
  return image;
}
// Returns a smooth image, which JPEG encodes with small errors.
Image smooth(int width, int height) {
  Image image(width, height, PixelFormat::srgb8);
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {x * 255 / width, y * 255 / height, 128})
        image.bytes()[i++] = static_cast<std::byte>(value);
  return image;
}
Image floats(int width, int height) {
  Image image(width, height, PixelFormat::linear32);
  test::Random random(2);
  std::vector<float> values;
  for (int i = 0; i < 3 * width * height; ++i)
    values.push_back(static_cast<float>(random.magnitude(1e-20, 1e20)));
  values[0] = 0;
  values[1] = 1e30f;
  std::memcpy(image.bytes().data(), values.data(), image.bytes().size());
  return image;
}
bool same(const Image& a, const Image& b) {
  return a.width() == b.width() && a.height() == b.height() && a.format() == b.format() &&
         std::equal(a.bytes().begin(), a.bytes().end(), b.bytes().begin(), b.bytes().end());
}
std::string problem(std::span<const std::byte> bytes, std::size_t max_pixels = std::size_t{1} << 24) {
  return test::error_of([&] { decode_image(bytes, max_pixels); });
}

constexpr std::array<std::pair<int, int>, 4> kSizes = {{{1, 1}, {3, 2}, {64, 64}, {257, 31}}};

TEST(Png, RoundTripsPixelsAtEveryCompressionLevel) {
  for (const auto& [width, height] : kSizes)
    for (const int level : {1, 6, 9}) {
      const Image image = noise(width, height);
      const std::string file = encode_png(image, {.level = level});
      EXPECT_TRUE(same(decode_image(bytes_of(file)), image)) << width << " x " << height;
      EXPECT_EQ(file, encode_png(image, {.level = level})) << "equal images have equal bytes";
    }
}

TEST(Encoding, StopsOnCancellation) {
  const Image codes = noise(8, 200), linear = floats(8, 200);
  std::stop_source source;
  const std::stop_token stop = source.get_token();
  const TaskScope scope({nullptr, &stop});
  EXPECT_NE(encode_png(codes), "");
  EXPECT_NE(encode_exr(linear), "");
  source.request_stop();
  EXPECT_THROW(encode_png(codes), Cancelled);
  EXPECT_THROW(encode_exr(linear), Cancelled);
}

TEST(Exr, RoundTripsFloatsBitwise) {
  for (const auto& [width, height] : kSizes) {
    const Image image = floats(width, height);
    EXPECT_TRUE(same(decode_image(bytes_of(encode_exr(image))), image)) << width << " x " << height;
  }
}

TEST(Jpeg, RoundTripsWithSmallErrors) {
  const Image image = smooth(200, 120);
  const Image back = decode_image(bytes_of(encode_jpeg(image, 95)));
  ASSERT_EQ(back.width(), 200);
  ASSERT_EQ(back.height(), 120);
  int largest = 0;
  for (std::size_t i = 0; i < back.bytes().size(); ++i)
    largest =
        std::max(largest, std::abs(static_cast<int>(back.bytes()[i]) - static_cast<int>(image.bytes()[i])));
  EXPECT_LE(largest, 8);
  EXPECT_LT(encode_jpeg(image, 50).size(), encode_jpeg(image, 95).size());
}

TEST(ImageDecoder, RejectsInvalidSignatures) {
  EXPECT_NE(problem({}), "accepted");
  EXPECT_NE(problem(bytes_of("GIF89a..................")), "accepted");
  EXPECT_NE(problem(bytes_of(std::string(1000, '\0'))), "accepted");
  for (std::string file : {encode_png(noise(8, 8)), encode_jpeg(noise(8, 8)), encode_exr(floats(8, 8))}) {
    file[0] = static_cast<char>(file[0] ^ 0x20);
    EXPECT_NE(problem(bytes_of(file)), "accepted");
  }
}

TEST(ImageDecoder, RejectsTruncatedFiles) {
  for (const std::string& file :
       {encode_png(noise(40, 30)), encode_jpeg(noise(40, 30)), encode_exr(floats(40, 30))})
    for (std::size_t kept = 0; kept < file.size() - 16; kept += 1 + kept / 16)
      EXPECT_NE(problem(bytes_of(file).first(kept)), "accepted")
          << file.substr(1, 3) << " cut to " << kept << " of " << file.size();
}

// Changes up to 3 of the first 600 bytes. The file must be rejected or decoded, without a crash.
TEST(ImageDecoder, SurvivesCorruptedFiles) {
  test::Random random(3);
  for (const std::string& file :
       {encode_png(noise(16, 16)), encode_jpeg(noise(16, 16)), encode_exr(floats(16, 16))})
    for (int i = 0; i < 2000; ++i) {
      std::string damaged = file;
      const int changes = 1 + random.below(3);
      for (int k = 0; k < changes; ++k)
        damaged[static_cast<std::size_t>(random.below(
            static_cast<int>(std::min<std::size_t>(file.size(), 600))))] = static_cast<char>(random.bits());
      try {
        decode_image(bytes_of(damaged), 1 << 16);
      } catch (const InputError&) {
      }
    }
}

void put_big_endian(std::string& file, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// Headers with huge sizes are rejected before memory for the pixels is allocated.
TEST(ImageDecoder, RejectsHugeDimensionsInHeaders) {
  std::string png = encode_png(noise(8, 8));
  put_big_endian(png, 16, 0x7fffffff);
  put_big_endian(png, 20, 0x7fffffff);
  EXPECT_NE(problem(bytes_of(png)), "accepted");

  std::string jpeg = encode_jpeg(noise(8, 8));
  const std::size_t frame = jpeg.find("\xff\xc0");  // marker, length (2), precision, height (2), width (2)
  ASSERT_NE(frame, std::string::npos);
  for (std::size_t i = frame + 5; i < frame + 9; ++i) jpeg[i] = '\xff';
  EXPECT_NE(problem(bytes_of(jpeg)), "accepted");

  std::string exr = encode_exr(floats(8, 8));
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t box = exr.find(window) + std::strlen(window) + 1 + std::strlen("box2i") + 1 +
                            4;  // min x, min y, max x, max y
    for (const std::size_t field : {box + 8, box + 12}) exr[field + 3] = '\x3f';
  }
  EXPECT_NE(problem(bytes_of(exr)), "accepted");
}

TEST(ImageDecoder, RejectsImagesAbovePixelLimit) {
  for (const std::string& file :
       {encode_png(noise(40, 30)), encode_jpeg(noise(40, 30)), encode_exr(floats(40, 30))}) {
    EXPECT_NE(problem(bytes_of(file), 1199), "accepted");
    EXPECT_EQ(problem(bytes_of(file), 1200), "accepted");
  }
}

}  // namespace
}  // namespace orrery
