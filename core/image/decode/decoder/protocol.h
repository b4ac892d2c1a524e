#pragma once

#include <cstdint>

namespace orrery {

// Protocol between read_picture() and the program orrery-decode. The command line is
//  orrery-decode PLUGIN BYTES
// PLUGIN is "webp" or the name of an OpenImageIO reader. BYTES is the memory that the program may allocate
// for this image. Standard input is the image file. The program writes a DecodedHeader to standard output,
// then either `text_bytes` of an error message or `width` x `height` texels. A texel is linear light: red,
// green and blue as float, and alpha if there are four channels. Rows are ordered from top to bottom.
struct DecodedHeader {
  std::uint32_t text_bytes;  // 0 if the image was decoded
  std::uint32_t width, height;
  std::uint32_t channels;  // 3 or 4
};

// Memory that a decoder needs for every image, in bytes. kDecoderBytes covers the pages that OpenImageIO's
// libraries write to while they load (42 MB, `grep RssAnon /proc/PID/status`). kDecoderRoom covers tables and
// row buffers.
inline constexpr std::uint64_t kDecoderBytes = 48 << 20;
inline constexpr std::uint64_t kDecoderRoom = 6 << 20;

// Rows of texels decoded at once. A tiled file is decoded by rows of tiles.
inline constexpr int kRowsAtOnce = 64;

}  // namespace orrery
