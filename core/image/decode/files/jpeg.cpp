#include "core/base/error.h"
#include "core/image/decode/picture_file.h"

namespace orrery {
namespace {

constexpr unsigned kMarker = 0xff;
enum Marker : unsigned {
  kFirstFrame = 0xc0,
  kProgressive = 0xc2,
  kHuffman = 0xc4,
  kExtension = 0xc8,
  kArithmetic = 0xcc,
  kLastFrame = 0xcf,
  kFirstRestart = 0xd0,
  kLastRestart = 0xd7,
  kEnd = 0xd9,
  kScan = 0xda,
  kFirstApplication = 0xe0,
  kAdobe = 0xee,
  kLastApplication = 0xef,
  kComment = 0xfe,
};

bool within(unsigned marker, Marker first, Marker last) { return marker >= first && marker <= last; }

bool is_frame(unsigned marker) {
  return within(marker, kFirstFrame, kLastFrame) && marker != kHuffman && marker != kExtension &&
         marker != kArithmetic;
}

// Returns whether the segment is Adobe's APP14 marker, which selects the colour transform. Segments with 64
// bytes of content or more are other data.
bool is_colour_transform(unsigned marker, std::string_view content) {
  return marker == kAdobe && content.starts_with("Adobe") && content.size() < 64;
}

void read_frame(unsigned marker, ByteReader reader, PictureFile& file) {
  reader.take(1);  // bits per sample
  file.height = reader.big_endian(2);
  file.width = reader.big_endian(2);
  file.channels = static_cast<int>(reader.byte());
  // A progressive file is decoded as a whole, with two bytes per coefficient. The edges are rounded up to
  // whole blocks.
  constexpr std::uint64_t kBlock = 32;
  if (marker == kProgressive)
    file.decoder_bytes =
        2 * static_cast<std::uint64_t>(file.channels) * (file.width + kBlock) * (file.height + kBlock);
}

// Skips the entropy-coded data of a scan. A byte 255 in the data is followed by 0 or a restart marker.
void skip_scan(std::string_view bytes, ByteReader& reader) {
  for (;;) {
    reader.take_until(static_cast<char>(kMarker));
    if (reader.left() == 0) fail_damaged(reader.offset(), "scan ends early");
    const auto next = static_cast<unsigned char>(bytes[reader.at()]);
    if (next == 0 || within(next, kFirstRestart, kLastRestart)) continue;
    reader = ByteReader(bytes, reader.at() - 1);
    return;
  }
}

}  // namespace

// Reads segments: a byte 255, a marker, a length of two bytes that includes itself, and the content. The
// header of a scan is followed by entropy-coded data. Truncated files are rejected, because libjpeg would
// fill in the missing data. Scans are limited, because libjpeg decodes all scans of a progressive file when
// it opens the file.
void inspect_jpeg(std::string_view bytes, PictureFile& file) {
  constexpr int kMaxScans = 256;  // typical files have 10
  ByteReader reader(bytes);
  file.keep(reader.take(2));
  for (int scans = 0;;) {
    std::size_t start = reader.at();
    if (const unsigned first = reader.byte(); first != kMarker)
      fail_damaged(start, "segment must begin with byte 255 (got " + std::to_string(first) + ")");
    unsigned marker = reader.byte();
    for (; marker == kMarker; marker = reader.byte()) ++start;
    if (marker == kEnd) {
      if (scans == 0) fail_damaged(start, "file ends without a scan");
      return file.keep(bytes.substr(start, 2));
    }
    const std::uint32_t length = reader.big_endian(2);
    if (length < 2)
      fail_damaged(reader.offset() - 2,
                   "segment length must be at least 2 (got " + std::to_string(length) + ")");
    const std::size_t begin = reader.offset();
    const std::string_view content = reader.take(length - 2);
    if (is_frame(marker)) read_frame(marker, ByteReader(content, 0, begin), file);
    if (marker == kScan) {
      if (file.channels == 0) fail_damaged(start, "scan precedes the image size");
      skip_scan(bytes, reader);
      if (++scans > kMaxScans)
        throw InputError("", "file has more than " + std::to_string(kMaxScans) + " scans (limit " +
                                 std::to_string(kMaxScans) + ")");
    }
    const bool describes = within(marker, kFirstApplication, kLastApplication) || marker == kComment;
    if (!describes || is_colour_transform(marker, content))
      file.keep(bytes.substr(start, reader.at() - start));
  }
}

}  // namespace orrery
