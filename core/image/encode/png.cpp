#include <png.h>

#include <cassert>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/image/encode/codecs.h"

namespace orrery {
namespace {

[[noreturn]] void fail(png_structp, png_const_charp message) { throw std::runtime_error(message); }
void ignore(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
  png_infop info = png_create_info_struct(png);
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

std::string encode_png(const Image& image, const PngOptions& options) {
  assert(image.format() == PixelFormat::srgb8);
  std::string out;
  Writer writer;
  png_set_write_fn(writer.png, &out, append, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width()),
               static_cast<png_uint_32>(image.height()), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(writer.png, options.level);
  // On rendered images, this filter alone gives as few bytes as choosing per row among all filters, in half
  // the time.
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(writer.png, writer.info);
  const auto bytes = image.bytes();
  for (int y = 0; y < image.height(); ++y) {
    checkpoint();
    png_write_row(writer.png, reinterpret_cast<png_const_bytep>(bytes.data()) +
                                  image.row_bytes() * static_cast<std::size_t>(y));
  }
  png_write_end(writer.png, nullptr);
  return out;
}

Image decode_png(std::span<const std::byte> bytes, std::size_t max_pixels) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> guard(&header, png_image_free);
  if (!png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()))
    throw damaged("PNG", header.message);
  check_size(header.width, header.height, max_pixels);
  header.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(header.width), static_cast<int>(header.height), PixelFormat::srgb8);
  if (!png_image_finish_read(&header, nullptr, image.bytes().data(), 0, nullptr))
    throw damaged("PNG", header.message);
  return image;
}

}  // namespace orrery
