#include "core/base/error.h"
#include "core/image/decode/picture_file.h"

// WebP (RFC 9649): section 2 (container), section 3.4 (lossless header). VP8 (RFC 6386): section 9.1.
namespace orrery {
namespace {

std::uint32_t little_endian(ByteReader& reader, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(reader.byte()) << (8 * i);
  return value;
}

constexpr std::uint32_t kSize = (1 << 14) - 1;  // bits of a width or height

// Reads the header of a lossy image.
void read_lossy(ByteReader content, PictureFile& file) {
  const std::size_t start = content.offset();
  content.take(3);  // frame tag
  if (content.take(3) != "\x9d\x01\x2a") fail_damaged(start, "image must begin with a key frame");
  file.width = little_endian(content, 2) & kSize;
  file.height = little_endian(content, 2) & kSize;
}

// Reads the header of a lossless image. Returns whether it has alpha.
bool read_lossless(ByteReader content, PictureFile& file) {
  const std::size_t start = content.offset();
  if (content.byte() != 0x2f) fail_damaged(start, "lossless image must begin with byte 47");
  const std::uint32_t bits = little_endian(content, 4);
  file.width = (bits & kSize) + 1;
  file.height = (bits >> 14 & kSize) + 1;
  return (bits >> 28 & 1) != 0;
}

}  // namespace

// Reads a RIFF header of 12 bytes, then chunks: a type of 4 letters, a length, the content, and a byte of
// padding if the length is odd. The whole file is kept, because its header contains its length.
void inspect_webp(std::string_view bytes, PictureFile& file) {
  ByteReader reader(bytes);
  file.keep(bytes);
  reader.take(12);
  bool has_alpha = false;
  while (file.width == 0) {
    const std::size_t start = reader.offset();
    const std::string_view type = reader.take(4);
    const std::uint32_t length = reader.little_endian_32();
    ByteReader content = reader.part(length);
    if (length % 2 == 1 && reader.left() > 0) reader.take(1);
    if (type == "VP8 ") read_lossy(content, file);
    if (type == "VP8L") has_alpha = read_lossless(content, file);
    if (type == "ALPH") has_alpha = true;
    if (type == "VP8X" && (content.byte() & 2) != 0)
      throw InputError("", "must be a still image (got an animation)");
    if (type == "ANMF") fail_damaged(start, "must be a still image (got an animation)");
  }
  file.channels = has_alpha ? 4 : 3;
  // The file is decoded as a whole: to 4 bytes per texel. A lossless image takes 4 more, a plane of alpha 1.
  file.decoder_bytes = 10 * file.width * file.height;
}

}  // namespace orrery
