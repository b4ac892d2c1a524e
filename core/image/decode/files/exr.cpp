#include <algorithm>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/image/decode/picture_file.h"

namespace orrery {
namespace {

// OpenImageIO compares each attribute with all others. Typical files have 10 to 50 attributes.
constexpr int kMaxAttributes = 1000;
constexpr std::size_t kMaxHeader = 1 << 20;  // bytes

// Maximum number of rows compressed as one block (OpenEXR, "Technical Introduction": DWAB).
constexpr std::uint64_t kBlockRows = 256;

struct Attribute {
  std::string_view name, type;
  ByteReader value;
};

// Reads the next attribute into `out`. Returns false at the end of the header.
bool next_attribute(ByteReader& reader, Attribute& out) {
  out.name = reader.take_until('\0');
  if (out.name.empty()) return false;
  out.type = reader.take_until('\0');
  const std::uint32_t size = reader.little_endian_32();
  out.value = reader.part(size);
  return true;
}

int count_channels(ByteReader list) {
  constexpr std::size_t kDescription = 16;  // type, linearity, sampling
  int channels = 0;
  for (; !list.take_until('\0').empty(); ++channels) list.take(kDescription);
  return channels;
}

[[noreturn]] void fail_header(std::size_t limit, const std::string& noun) {
  throw InputError("",
                   "header has more than " + grouped(limit) + " " + noun + " (limit " + grouped(limit) + ")");
}

// Returns the number of texels from the first to the last coordinate, or 0 if `last` is below `first`.
std::uint64_t extent(std::uint32_t first, std::uint32_t last) {
  const std::int64_t between =
      std::int64_t{static_cast<std::int32_t>(last)} - static_cast<std::int32_t>(first);
  return between < 0 ? 0 : static_cast<std::uint64_t>(between) + 1;
}

// Reads one header, up to the empty attribute name at its end. Adds the number of attributes to `attributes`.
// Returns false if the header has no attributes.
bool read_header(ByteReader& reader, int& attributes, PictureFile& file) {
  std::uint64_t rows = kBlockRows, tile_width = 0;
  Attribute attribute{{}, {}, ByteReader({})};
  const int before = attributes;
  for (; next_attribute(reader, attribute); ++attributes) {
    if (attributes == kMaxAttributes) fail_header(kMaxAttributes, "attributes");
    if (reader.at() > kMaxHeader) fail_header(kMaxHeader, "bytes");
    if (attribute.name == "channels" && attribute.type == "chlist")
      file.channels = count_channels(attribute.value);
    if (attribute.name == "dataWindow" && attribute.type == "box2i") {
      std::uint32_t edges[4];
      for (std::uint32_t& edge : edges) edge = attribute.value.little_endian_32();
      file.width = extent(edges[0], edges[2]);
      file.height = extent(edges[1], edges[3]);
    }
    if (attribute.name == "tiles" && attribute.type == "tiledesc") {
      tile_width = attribute.value.little_endian_32();
      rows = attribute.value.little_endian_32();
    }
  }
  // Memory of one row of blocks or tiles, with 4 bytes per sample. The decoder has three copies: compressed,
  // uncompressed, and in texel order. A tile may extend beyond the image.
  constexpr std::uint64_t kMaxSide = 1 << 16, kCopies = 3;
  const std::uint64_t width = std::min(std::max(file.width, tile_width), kMaxSide);
  file.decoder_bytes =
      kCopies * 4 * static_cast<std::uint64_t>(file.channels) * width * std::min(rows, kMaxSide);
  return attributes > before;
}

}  // namespace

// Reads the magic number, the flags and the header. A multi-part file has one header per part, and an empty
// header at the end. The first header determines the size.
void inspect_exr(std::string_view bytes, PictureFile& file) {
  constexpr std::uint32_t kDeep = 0x800, kManyParts = 0x1000;
  ByteReader reader(bytes);
  reader.take(4);
  const std::uint32_t flags = reader.little_endian_32();
  if (flags & kDeep) throw InputError("", "must be a flat image (got a deep image)");
  int attributes = 0;
  read_header(reader, attributes, file);
  PictureFile other{.format = file.format, .parts = {}};
  while (flags & kManyParts && read_header(reader, attributes, other)) {
  }
  file.keep(bytes);
}

}  // namespace orrery
