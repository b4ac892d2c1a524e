#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace orrery {

enum class FileFormat { png, jpeg, exr };

struct PngOptions {
  int level = 4;  // zlib's, 1..9; 1 for frames of a stream. 6 takes twice the time for 0 to 10 % fewer bytes
};

// Bytes of a file that holds the picture. PNG and JPEG take srgb8, EXR takes linear32 (half floats would lose
// what comparisons need, so it stores floats). The same picture gives the same bytes.
// PNG and EXR have interruption points.
std::string encode_png(const Image& image, const PngOptions& options = {});
std::string encode_jpeg(const Image& image, int quality = 92);
// One more channel of an EXR file: as many values as the picture has pixels, row by row.
struct ExrLayer {
  std::string name;
  std::vector<float> values;
};
std::string encode_exr(const Image& image, std::span<const ExrLayer> layers = {});

// Reads a picture of any of the three formats, told by its first bytes. Throws InputError if it is none of
// them, is damaged or has more than `max_pixels`.
Image decode_image(std::span<const std::byte> bytes, std::size_t max_pixels = std::size_t{1} << 24);

}  // namespace orrery
