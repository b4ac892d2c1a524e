#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/decode/picture.h"

namespace orrery {

// Header data of an image file, read before decoding.
struct PictureFile {
  PictureFormat format;
  std::uint64_t width = 0, height = 0;
  int channels = 0;
  // Maximum memory of the decoder for this file in bytes, in addition to kDecoderBytes and the decoded rows.
  std::uint64_t decoder_bytes = 0;
  // Parts of the file that affect texels, in order. Texts, profiles and thumbnails are dropped, because
  // decoders spend memory and time on them.
  std::vector<std::string_view> parts;

  // Appends the bytes as a new part, or extends the last part if the bytes directly follow it.
  void keep(std::string_view bytes) {
    if (!parts.empty() && parts.back().data() + parts.back().size() == bytes.data())
      parts.back() = {parts.back().data(), parts.back().size() + bytes.size()};
    else
      parts.push_back(bytes);
  }
};

// Reads the header of a file without decoding it. The parts point into `bytes`. Takes time linear in the file
// size. Throws InputError (pointer "") if the file is damaged, if the image size exceeds the limits, or if
// the header is too large.
PictureFile inspect_picture(std::string_view bytes, PictureFormat format, const PictureLimits& limits);

// Read the header and set all members but the format. Throw InputError (pointer "") if the file is damaged.
void inspect_png(std::string_view bytes, PictureFile& file);
void inspect_jpeg(std::string_view bytes, PictureFile& file);
void inspect_webp(std::string_view bytes, PictureFile& file);
void inspect_exr(std::string_view bytes, PictureFile& file);
void inspect_hdr(std::string_view bytes, PictureFile& file);

// Sequential reader of the bytes of a file, or of a part that begins at byte `begin` of the file. Reading
// beyond the end throws InputError.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes, std::size_t at = 0, std::size_t begin = 0)
      : bytes_(bytes), at_(at), begin_(begin) {}

  std::size_t at() const { return at_; }
  std::size_t offset() const { return begin_ + at_; }  // in the file
  std::size_t left() const { return bytes_.size() - at_; }
  std::string_view take(std::size_t count);
  ByteReader part(std::size_t count);     // returns a reader of the next `count` bytes and skips them
  std::string_view take_until(char end);  // skips `end`, which is not part of the result
  unsigned byte() { return static_cast<unsigned char>(take(1)[0]); }
  std::uint32_t big_endian(int bytes);
  std::uint32_t little_endian_32();

 private:
  std::string_view bytes_;
  std::size_t at_, begin_;
};

// Throws InputError with the text "damaged at byte N: " + `why`. `byte` is counted from 0 in the file.
[[noreturn]] void fail_damaged(std::size_t byte, const std::string& why);

}  // namespace orrery
