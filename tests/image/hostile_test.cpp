#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <thread>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/decode/decode_process.h"
#include "core/image/decode/picture_file.h"
#include "core/image/encode/files.h"
#include "tests/support/errors.h"
#include "tests/support/sanitized.h"

// Tests files that make decoders use memory or time for data other than texels.
namespace orrery::test {
namespace {

using namespace std::string_literals;
using namespace std::string_view_literals;

Image grey_image(int width, int height) {
  Image image(width, height, PixelFormat::srgb8);
  std::memset(image.bytes().data(), 128, image.bytes().size());
  return image;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}
std::string little_endian(std::uint32_t value) {
  const std::string bytes = big_endian(value);
  return {bytes.rbegin(), bytes.rend()};
}

std::string png_chunk(const std::string& type, const std::string& content) {
  const std::string checked = type + content;
  const auto crc =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(content.size())) + checked +
         big_endian(static_cast<std::uint32_t>(crc));
}

std::string jpeg_segment(char marker, const std::string& content) {
  return "\xff"s + marker + big_endian(static_cast<std::uint32_t>(content.size() + 2)).substr(2) + content;
}

std::string exr_attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + little_endian(static_cast<std::uint32_t>(value.size())) + value;
}

// Returns a progressive JPEG whose `scans` scans contain only end-of-band codes. A scan takes a few bytes for
// each 32,767 blocks of 8 x 8 texels.
std::string progressive_jpeg(int width, int height, int components, int scans) {
  std::string file = "\xff\xd8" + jpeg_segment('\xdb', '\0' + std::string(64, '\1'));
  std::string frame = "\x08"s + big_endian(static_cast<std::uint32_t>(height)).substr(2) +
                      big_endian(static_cast<std::uint32_t>(width)).substr(2) + static_cast<char>(components);
  for (int i = 1; i <= components; ++i) frame += std::string{static_cast<char>(i), '\x11', '\0'};
  file += jpeg_segment('\xc2', frame);
  // Huffman codes: 0 = end-of-band run of at least 2^14 blocks, 10 = end of band in one block.
  file += jpeg_segment('\xc4', "\x10\1\1"s + std::string(14, '\0') + "\xe0\0"s);
  std::string bits;
  int left = (width + 7) / 8 * ((height + 7) / 8);
  for (; left >= 32767; left -= 32767) bits += "0" + std::string(14, '1');
  for (; left > 0; --left) bits += "10";
  std::string coded;
  while (bits.size() % 8 != 0) bits += '1';
  for (std::size_t i = 0; i < bits.size(); i += 8) {
    coded += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
    if (coded.back() == '\xff') coded += '\0';
  }
  for (int scan = 0; scan < scans; ++scan)
    file += jpeg_segment('\xda', {'\1', static_cast<char>(scan % components + 1), '\0',
                                  static_cast<char>(scan % 63 + 1), static_cast<char>(scan % 63 + 1), '\0'}) +
            coded;
  return file + "\xff\xd9";
}

std::string joined(const PictureFile& file) {
  std::string all;
  for (const std::string_view part : file.parts) all += part;
  return all;
}

PictureFile inspect(std::string_view bytes) { return inspect_picture(bytes, picture_format(bytes), {}); }

std::string refusal(const std::string& bytes) {
  return detail_of([&] { inspect(bytes); });
}

TEST(PictureDecoder, StripsTextChunksFromPng) {
  const std::string plain = encode_png(grey_image(8, 8));
  std::string with_texts = plain;
  for (int i = 0; i < 100; ++i)
    with_texts.insert(33, png_chunk("zTXt", "key"s + '\0' + '\0' + std::string(1000, 'x')));  // after IHDR
  EXPECT_EQ(joined(inspect(with_texts)).find("zTXt"), std::string::npos);
  EXPECT_EQ(read_picture(with_texts).rgb, read_picture(plain).rgb);
}

TEST(PictureDecoder, StripsCommentsAndProfilesFromJpeg) {
  const std::string plain = encode_jpeg(grey_image(16, 8));
  std::string described = plain;
  for (int i = 0; i < 60'000; ++i) described.insert(2, jpeg_segment('\xfe', "comment"));
  described.insert(2, jpeg_segment('\xe2', "ICC_PROFILE"));
  const std::string kept = joined(inspect(described));
  EXPECT_LE(kept.size(), plain.size());
  EXPECT_EQ(read_picture(described).rgb, read_picture(plain).rgb);
}

// Without the Adobe segment, a decoder would read red, green and blue as luminance and colour differences.
TEST(PictureDecoder, KeepsColourTransformOfJpeg) {
  std::string described = encode_jpeg(grey_image(16, 8));
  described.insert(2, jpeg_segment('\xee', "Adobe\0\x64\0\0\0\0\0"s));
  EXPECT_NE(joined(inspect(described)).find("Adobe"), std::string::npos);
}

TEST(PictureDecoder, LimitsExrHeader) {
  Image image(4, 4, PixelFormat::linear32);
  std::memset(image.bytes().data(), 0, image.bytes().size());
  const std::string plain = encode_exr(image);
  const auto with = [&plain](int attributes, std::size_t bytes) {
    std::string added;
    for (int i = 0; i < attributes; ++i)
      added += exr_attribute("a" + std::to_string(i), "string", std::string(bytes, 'x'));
    std::string file = plain;
    return file.insert(8, added);
  };
  EXPECT_EQ(refusal(with(900, 4)), "accepted");
  EXPECT_EQ(refusal(with(1001, 4)), "header has more than 1,000 attributes (limit 1,000)");
  EXPECT_EQ(refusal(with(2, 1 << 20)), "header has more than 1,048,576 bytes (limit 1,048,576)");
  std::string deep = plain;
  deep[5] |= 0x8;
  EXPECT_EQ(refusal(deep), "must be a flat image (got a deep image)");
}

TEST(PictureDecoder, LimitsHdrHeader) {
  EXPECT_EQ(refusal("#?RADIANCE\n" + std::string(70'000, 'x') + "\n\n-Y 1 +X 1\n"),
            "header has more than 65,536 bytes (limit 65,536)");
}

// This file of 360 bytes makes libjpeg allocate 256 MiB, two bytes for each coefficient.
TEST(PictureDecoder, ChargesDecoderMemory) {
  const std::string bytes = progressive_jpeg(16384, 2048, 4, 4);
  ASSERT_LT(bytes.size(), 1000u);
  EXPECT_GE(inspect(bytes).decoder_bytes, 2u * 4 * 16384 * 2048);
  constexpr std::size_t kMost = 200 << 20;
  class LimitedMemory final : public MemoryAccount {
   public:
    void add(std::size_t bytes) override {
      asked = std::max(asked, bytes);
      if (bytes > kMost) throw Busy("no more", 1);
    }
    void remove(std::size_t) noexcept override {}
    void require_granted() override {}
    std::size_t asked = 0;
  } memory;
  const TaskScope scope({&memory});
  EXPECT_THROW(read_picture(bytes), Busy);
  EXPECT_GE(memory.asked, 2u * 4 * 16384 * 2048);
}

TEST(PictureDecoder, LimitsDecoderMemoryToEstimate) {
  if (kSanitized) GTEST_SKIP() << "sanitizers disable memory limits";
  const std::string bytes = progressive_jpeg(16384, 2048, 4, 4);
  PictureFile file = inspect(bytes);
  file.decoder_bytes = 0;
  EXPECT_THROW(decode_in_process(file), InputError);
}

// Decoding would take seconds: each scan visits all blocks.
TEST(PictureDecoder, StopsOnCancellation) {
  const std::string bytes = progressive_jpeg(16384, 2048, 1, 250);
  std::stop_source stop;
  std::jthread canceller([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  const std::stop_token token = stop.get_token();
  const TaskScope scope({nullptr, &token});
  EXPECT_THROW(read_picture(bytes), Cancelled);
}

TEST(PictureDecoder, SurvivesTruncatedHeaders) {
  std::vector<std::string> files = {encode_png(grey_image(8, 8)), encode_jpeg(grey_image(8, 8)),
                                    encode_exr(Image(8, 8, PixelFormat::linear32))};
  for (const std::string& file : files)
    for (std::size_t kept = 4; kept < std::min<std::size_t>(file.size(), 300); ++kept)
      ASSERT_NE(refusal(file.substr(0, kept)), "") << kept;  // neither a crash nor a hang
}

}  // namespace
}  // namespace orrery::test
