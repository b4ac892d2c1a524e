#include "core/image/decode/picture_file.h"

#include "core/base/error.h"

namespace orrery {

PictureFile inspect_picture(std::string_view bytes, PictureFormat format, const PictureLimits& limits) {
  PictureFile file{.format = format, .parts = {}};
  switch (format) {
    case PictureFormat::exr: inspect_exr(bytes, file); break;
    case PictureFormat::hdr: inspect_hdr(bytes, file); break;
    case PictureFormat::png: inspect_png(bytes, file); break;
    case PictureFormat::jpeg: inspect_jpeg(bytes, file); break;
    case PictureFormat::webp: inspect_webp(bytes, file); break;
  }
  if (std::string problem = limits.problem_of(file.width, file.height, file.channels); !problem.empty())
    throw InputError("", std::move(problem));
  return file;
}

std::string_view ByteReader::take(std::size_t count) {
  if (count > left())
    fail_damaged(offset(), "data ends early (needs " + std::to_string(count) +
                               (count == 1 ? " byte" : " bytes") + ", got " + std::to_string(left()) + ")");
  at_ += count;
  return bytes_.substr(at_ - count, count);
}

ByteReader ByteReader::part(std::size_t count) {
  const std::size_t begin = offset();
  return ByteReader(take(count), 0, begin);
}

std::string_view ByteReader::take_until(char end) {
  const std::size_t found = bytes_.find(end, at_);
  if (found == std::string_view::npos)
    fail_damaged(offset(),
                 "data ends early (no byte " + std::to_string(static_cast<unsigned char>(end)) + " follows)");
  const std::string_view taken = bytes_.substr(at_, found - at_);
  at_ = found + 1;
  return taken;
}

std::uint32_t ByteReader::big_endian(int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | byte();
  return value;
}

std::uint32_t ByteReader::little_endian_32() {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= byte() << (8 * i);
  return value;
}

void fail_damaged(std::size_t byte, const std::string& why) {
  throw InputError("", "damaged at byte " + std::to_string(byte) + ": " + why);
}

}  // namespace orrery
