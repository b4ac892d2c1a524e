#include <turbojpeg.h>

#include <cassert>
#include <memory>
#include <stdexcept>

#include "core/image/encode/codecs.h"

namespace orrery {
namespace {

struct Close {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Close>;

}  // namespace

std::string encode_jpeg(const Image& image, int quality) {
  assert(image.format() == PixelFormat::srgb8);
  const Handle handle(tjInitCompress());
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed =
      tjCompress2(handle.get(), reinterpret_cast<const unsigned char*>(image.bytes().data()), image.width(),
                  0, image.height(), TJPF_RGB, &bytes, &size, TJSAMP_444, quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> guard(bytes, tjFree);
  if (failed) throw std::runtime_error(tjGetErrorStr2(handle.get()));
  return {reinterpret_cast<const char*>(bytes), size};
}

Image decode_jpeg(std::span<const std::byte> bytes, std::size_t max_pixels) {
  const Handle handle(tjInitDecompress());
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colors = 0;
  if (tjDecompressHeader3(handle.get(), data, bytes.size(), &width, &height, &subsampling, &colors))
    throw damaged("JPEG", tjGetErrorStr2(handle.get()));
  check_size(static_cast<std::size_t>(width), static_cast<std::size_t>(height), max_pixels);
  Image image(width, height, PixelFormat::srgb8);
  if (tjDecompress2(handle.get(), data, bytes.size(), reinterpret_cast<unsigned char*>(image.bytes().data()),
                    width, 0, height, TJPF_RGB, TJFLAG_ACCURATEDCT))
    throw damaged("JPEG", tjGetErrorStr2(handle.get()));
  return image;
}

}  // namespace orrery
