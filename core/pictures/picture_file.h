#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/pictures/picture.h"

namespace orrery {

// A picture file as its header states it, before a decoder sees it.
struct PictureFile {
  PictureFormat format;
  std::uint64_t width = 0, height = 0;
  int channels = 0;
  // Bytes that a decoder allocates at most, besides what any file takes.
  std::uint64_t decoder_bytes = 0;
  // The parts of the file that make texels, in order. Texts, profiles and thumbnails are left out: decoders
  // spend memory and time on them.
  std::vector<std::string_view> parts;

  // Adds bytes that follow the last part or stand apart from it.
  void keep(std::string_view bytes) {
    if (!parts.empty() && parts.back().data() + parts.back().size() == bytes.data())
      parts.back() = {parts.back().data(), parts.back().size() + bytes.size()};
    else
      parts.push_back(bytes);
  }
};

// Reads the header of a file of that format without decoding anything; the parts point into `bytes`. Takes
// time linear in the size of the file. Throws InputError (pointer "") if the file is damaged, its size is
// beyond the limits, or its header is larger than a picture needs.
PictureFile inspect_picture(std::string_view bytes, PictureFormat format, const PictureLimits& limits);

// Each sets all but the format, or throws InputError (pointer "").
void inspect_png(std::string_view bytes, PictureFile& file);
void inspect_jpeg(std::string_view bytes, PictureFile& file);
void inspect_exr(std::string_view bytes, PictureFile& file);
void inspect_hdr(std::string_view bytes, PictureFile& file);

// Bytes of a file, read in order. Reading beyond the end throws InputError that says the file has no end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  std::string_view take(std::size_t count);
  std::string_view take_until(char end);  // without `end`, which is read too
  unsigned byte() { return static_cast<unsigned char>(take(1)[0]); }
  std::uint32_t big_endian(int bytes);
  std::uint32_t little_endian_32();

 private:
  std::string_view bytes_;
  std::size_t at_;
};

// Throws InputError: "the picture is damaged: " and `why`.
[[noreturn]] void fail_damaged(const std::string& why);

}  // namespace orrery
