#include "core/image/encode/files.h"

#include <algorithm>
#include <array>

#include "core/image/encode/codecs.h"

namespace orrery {
namespace {

template <std::size_t count>
bool starts_with(std::span<const std::byte> bytes, const std::array<unsigned char, count>& magic) {
  return bytes.size() >= count && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                             [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

constexpr std::array<unsigned char, 8> kPngMagic = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<unsigned char, 3> kJpegMagic = {0xff, 0xd8, 0xff};
constexpr std::array<unsigned char, 4> kExrMagic = {0x76, 0x2f, 0x31, 0x01};

}  // namespace

Image decode_image(std::span<const std::byte> bytes, std::size_t max_pixels) {
  if (starts_with(bytes, kPngMagic)) return decode_png(bytes, max_pixels);
  if (starts_with(bytes, kJpegMagic)) return decode_jpeg(bytes, max_pixels);
  if (starts_with(bytes, kExrMagic)) return decode_exr(bytes, max_pixels);
  throw InputError("", "must be a PNG, JPEG or EXR image");
}

}  // namespace orrery
