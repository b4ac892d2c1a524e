#pragma once

#include <cstdint>

namespace orrery {

// How read_picture() and the program orrery-decode understand each other. The program is called as
//   orrery-decode PLUGIN BYTES
// with the name of OpenImageIO's reader and the memory that it may allocate for this picture. Standard input
// is a file with the picture. To standard output it writes a DecodedHeader, then either `text_bytes` of a
// message or `width` x `height` texels of linear light, row by row from the top: red, green and blue as
// float.
struct DecodedHeader {
  std::uint32_t text_bytes;  // 0 if the picture was decoded
  std::uint32_t width, height;
};

// What every decoder takes, whatever the picture: the pages that OpenImageIO's libraries write to as they are
// loaded (42 MB, `grep RssAnon /proc/PID/status`), and room for tables and rows.
inline constexpr std::uint64_t kDecoderBytes = 48 << 20;
inline constexpr std::uint64_t kDecoderRoom = 6 << 20;

// Rows of texels that are decoded at once; of a tiled file a row of tiles.
inline constexpr int kRowsAtOnce = 64;

}  // namespace orrery
