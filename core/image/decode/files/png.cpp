#include <algorithm>
#include <array>

#include "core/image/decode/picture_file.h"

namespace orrery {
namespace {

constexpr std::array<std::string_view, 7> kTexelChunks = {"IHDR", "PLTE", "tRNS", "gAMA",
                                                          "sRGB", "IDAT", "IEND"};

// Returns the number of channels of a colour type (PNG specification, 11.2.2). A palette counts as 4
// channels, because a tRNS chunk may add alpha.
int channels_of(unsigned colour_type, std::size_t offset) {
  switch (colour_type) {
    case 0: return 1;
    case 2: return 3;
    case 3: return 4;
    case 4: return 2;
    case 6: return 4;
    default:
      fail_damaged(offset,
                   "colour type must be one of 0, 2, 3, 4 or 6 (got " + std::to_string(colour_type) + ")");
  }
}

}  // namespace

// Reads a signature of 8 bytes, then chunks: a length, a type of 4 letters, the content and a checksum.
void inspect_png(std::string_view bytes, PictureFile& file) {
  ByteReader reader(bytes);
  file.keep(reader.take(8));
  for (std::string_view type; type != "IEND";) {
    const std::size_t start = reader.at();
    const std::uint32_t length = reader.big_endian(4);
    type = reader.take(4);
    ByteReader content = reader.part(length);
    reader.take(4);
    if (file.width == 0 && type != "IHDR")
      fail_damaged(start, "first chunk must be IHDR, which contains the size");
    if (type == "IHDR") {
      file.width = content.big_endian(4);
      file.height = content.big_endian(4);
      const std::uint64_t depth = content.byte();
      const std::size_t offset = content.offset();
      file.channels = channels_of(content.byte(), offset);
      content.take(2);                              // compression and filter methods
      const bool interlaced = content.byte() != 0;  // interlaced files are decoded as a whole
      if (interlaced)
        file.decoder_bytes =
            file.width * file.height * static_cast<std::uint64_t>(file.channels) * (depth > 8 ? 2 : 1);
      if (file.width == 0) fail_damaged(start, "width must be at least 1 (got 0)");
    }
    const bool makes_texels = std::find(kTexelChunks.begin(), kTexelChunks.end(), type) != kTexelChunks.end();
    if (makes_texels) file.keep(bytes.substr(start, reader.at() - start));
  }
}

}  // namespace orrery
