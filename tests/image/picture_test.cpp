#include "core/image/decode/picture.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <regex>

#include "core/base/error.h"
#include "core/image/encode/files.h"
#include "tests/support/errors.h"

// Tests the reading of encoded images, damaged images and other files.
namespace orrery::test {
namespace {

using namespace std::string_literals;

Image linear_image(int width, int height, const std::vector<float>& rgb) {
  Image image(width, height, PixelFormat::linear32);
  std::memcpy(image.bytes().data(), rgb.data(), rgb.size() * sizeof(float));
  return image;
}
Image coded_image(int width, int height, unsigned char code) {
  Image image(width, height, PixelFormat::srgb8);
  std::memset(image.bytes().data(), code, image.bytes().size());
  return image;
}
std::vector<float> ramp(std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(0.25f * static_cast<float>(i));
  return values;
}

// Returns an HDR file of uncompressed RGBE texels with red 0.5, green 1 and blue 4. The header states the
// height `stated_height`.
std::string hdr(int width, int height, int stated_height) {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(stated_height) + " +X " +
                      std::to_string(width) + "\n";
  for (int i = 0; i < width * height; ++i) bytes += std::string("\x10\x20\x80\x83", 4);
  return bytes;
}

std::string refusal(const std::string& bytes, const PictureLimits& limits = {}) {
  return detail_of([&] { read_picture(bytes, limits); });
}

TEST(Pictures, ReadsExrUnchanged) {
  const std::vector<float> values = ramp(5 * 3 * 3);
  const Texels read = read_picture(encode_exr(linear_image(5, 3, values)));
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.rgb, values);
}

TEST(Pictures, ReadsHdrAsLinear) {
  const Texels read = read_picture(hdr(4, 2, 2));
  ASSERT_EQ(read.rgb.size(), 24u);
  EXPECT_NEAR(read.rgb[0], 0.5, 0.02);
  EXPECT_NEAR(read.rgb[1], 1, 0.02);
  EXPECT_NEAR(read.rgb[2], 4, 0.02);
}

// IEC 61966-2-1: code 128 is 0.2158605, code 10 is on the linear segment.
TEST(Pictures, DecodesPngAndJpegFromSrgb) {
  for (const auto& [code, linear] :
       {std::pair<int, double>{128, 0.21586050}, {10, 10.0 / 255 / 12.92}, {255, 1}}) {
    const Image image = coded_image(16, 8, static_cast<unsigned char>(code));
    EXPECT_NEAR(read_picture(encode_png(image)).rgb[5], linear, 1e-7) << code;
    EXPECT_NEAR(read_picture(encode_jpeg(image)).rgb[5], linear, 0.01) << code;
  }
}

TEST(Pictures, RejectsTruncatedFiles) {
  const std::string exr = encode_exr(linear_image(64, 64, ramp(64 * 64 * 3))),
                    png = encode_png(coded_image(64, 64, 77)), jpeg = encode_jpeg(coded_image(64, 64, 77)),
                    flat = hdr(64, 64, 64);
  for (const std::string& whole : {exr, png, jpeg, flat})
    for (const double share : {0.02, 0.3, 0.6, 0.9}) {
      const auto kept =
          std::max<std::size_t>(12, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
      EXPECT_NE(refusal(whole.substr(0, kept)), "accepted") << whole.substr(1, 3) << " " << share;
    }
  for (std::size_t kept = 8; kept < png.size(); ++kept)
    ASSERT_TRUE(std::regex_match(
        refusal(png.substr(0, kept)),
        std::regex("PNG: damaged at byte \\d+: data ends early \\(needs \\d+ bytes?, got \\d+\\)")))
        << kept;
}

// Sizes in a header are compared with the limits before anything is decoded.
TEST(Pictures, ChecksHeaderSizesBeforeDecoding) {
  EXPECT_EQ(refusal(hdr(4, 2, 2'000'000'000)),
            "HDR: image has 4 x 2000000000 texels (limits: 1 to 16,384 per side [picture_side], 33,554,432 "
            "in total [picture_texels])");
  EXPECT_NE(refusal(hdr(4, 2, 0)), "accepted");
  std::string png = encode_png(coded_image(8, 8, 1));
  const auto state = [&png](std::uint32_t width, std::uint32_t height) {
    for (std::size_t i = 0; i < 4; ++i) {
      png[16 + i] = static_cast<char>(width >> (24 - 8 * i));
      png[20 + i] = static_cast<char>(height >> (24 - 8 * i));
    }
    const auto crc =
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17));
    for (std::size_t i = 0; i < 4; ++i) png[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
  };
  for (const auto& [width, height] :
       {std::pair<std::uint32_t, std::uint32_t>{16385, 1}, {16000, 16000}, {900'000, 900'000}, {0, 8}}) {
    state(width, height);
    EXPECT_NE(refusal(png), "accepted") << width << " x " << height;
  }
  EXPECT_NE(refusal(hdr(4, 2, 2), {.side = 3}), "accepted");
  EXPECT_NE(refusal(hdr(4, 2, 2), {.texels = 7}), "accepted");
  EXPECT_EQ(refusal(hdr(4, 2, 2), {.side = 4, .texels = 8}), "accepted");
  EXPECT_EQ(refusal(hdr(4, 2, 2), {.channels = 2}), "HDR: image must have 1 to 2 channels (got 3)");
}

// libjpeg decodes a progressive file completely when it opens the file.
TEST(Pictures, RejectsCostlyJpegBeforeDecoding) {
  const std::string frame = "\xff\xc2\x00\x0b\x08\x2e\xe0\x5d\xc0\x01\x01\x11\x00"s,
                    scan = "\xff\xda\x00\x08\x01\x01\x00\x00\x00\x00"s;
  EXPECT_EQ(refusal("\xff\xd8" + frame + scan + "\xff\xd9"),
            "JPEG: image has 24000 x 12000 texels (limits: 1 to 16,384 per side [picture_side], 33,554,432 "
            "in total [picture_texels])");
  EXPECT_EQ(refusal("\xff\xd8" + scan + "\xff\xd9"), "JPEG: damaged at byte 2: scan precedes the image size");
  std::string many = encode_jpeg(coded_image(8, 8, 1));
  for (int i = 0; i < 256; ++i) many.insert(many.size() - 2, scan);
  EXPECT_EQ(refusal(many), "JPEG: file has more than 256 scans (limit 256)");
}

TEST(Pictures, ReportsPositionOfDamage) {
  std::string png = encode_png(coded_image(8, 8, 1));
  png[25] = 5;  // colour type
  EXPECT_EQ(refusal(png), "PNG: damaged at byte 25: colour type must be one of 0, 2, 3, 4 or 6 (got 5)");
  png = encode_png(coded_image(8, 8, 1));
  png[12] = 'X';
  EXPECT_EQ(refusal(png), "PNG: damaged at byte 8: first chunk must be IHDR, which contains the size");
  EXPECT_EQ(refusal("\xff\xd8\xff\xe0\x00\x01"s),
            "JPEG: damaged at byte 4: segment length must be at least 2 (got 1)");
  EXPECT_EQ(refusal("\xff\xd8\xff\xe0\x00\x02x"s),
            "JPEG: damaged at byte 6: segment must begin with byte 255 (got 120)");
  EXPECT_EQ(refusal("\xff\xd8\xff\xd9"), "JPEG: damaged at byte 2: file ends without a scan");
  EXPECT_EQ(refusal("#?RGBE\n\nX\n"), "HDR: damaged at byte 8: size must have the form -Y 512 +X 1024");
  EXPECT_EQ(refusal("#?RGBE\n"), "HDR: damaged at byte 7: data ends early (size is missing)");
  EXPECT_EQ(refusal("\x76\x2f\x31\x01"), "EXR: damaged at byte 4: data ends early (needs 1 byte, got 0)");
}

// Messages of the libraries have several lines and contain an internal file name.
TEST(Pictures, ShortensLibraryErrorsToOneLine) {
  std::string png = encode_png(coded_image(8, 8, 1));
  png[png.size() - 13] = static_cast<char>(png[png.size() - 13] ^ 1);  // checksum of the last IDAT
  EXPECT_EQ(refusal(png), "PNG: image is damaged: IDAT: CRC error");
}

TEST(Pictures, ReportsInvalidTexels) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {-1.0f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), 2e9f}) {
    std::vector<float> values(4 * 3 * 3, 0.5f);
    values[(2 * 4 + 1) * 3 + 1] = bad;
    const std::string said = refusal(encode_exr(linear_image(4, 3, values)));
    EXPECT_NE(said.find("texels must be from 0 to 1e+09 (got "), std::string::npos) << said;
    EXPECT_NE(said.find(" in column 1 of row 2"), std::string::npos) << said;
  }
}

TEST(Pictures, ClampsAFewInvalidTexels) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> values(16 * 16 * 3, 0.5f);
  const std::array bad = {-1.0f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
  for (std::size_t i = 0; i < bad.size(); ++i) values[100 * i] = bad[i];
  const Texels read = read_picture(encode_exr(linear_image(16, 16, values)));
  EXPECT_EQ(read.clamped, 4);
  EXPECT_EQ(read.rgb[0], 0);
  EXPECT_EQ(read.rgb[100], kMaxTexel);
  EXPECT_EQ(read.rgb[200], 0);
  EXPECT_EQ(read.rgb[300], 0);
  EXPECT_EQ(read.rgb[1], 0.5f);
}

TEST(Pictures, RejectsOtherFormatsAndBareSignatures) {
  for (const std::string& bytes :
       {std::string(), std::string("v 0 0 0\n"), std::string("GIF89a"), std::string("II*\0", 4),
        std::string("\x89PNG\r\n\x1a\n"), std::string("\xff\xd8\xff"), std::string("#?RGBE\n"),
        std::string("\x76\x2f\x31\x01")})
    EXPECT_NE(refusal(bytes), "accepted");
  EXPECT_FALSE(is_picture("v 0 0 0\n"));
  EXPECT_TRUE(is_picture(hdr(1, 1, 1)));
}

}  // namespace
}  // namespace orrery::test
