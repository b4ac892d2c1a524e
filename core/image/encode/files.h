#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace orrery {

enum class FileFormat { png, jpeg, exr };

struct PngOptions {
  int level = 4;  // zlib level, 1 to 9; 6 takes twice the time of 4 and saves 0 to 10 % of the bytes
};

// Encode an image. PNG and JPEG require srgb8. EXR requires linear32 and stores floats, because half floats
// lose precision that comparisons need. Equal images give equal bytes. PNG and EXR encoding have interruption
// points and throw Cancelled. If the codec library fails, encoders throw a std::exception that is not an
// Error. All functions here are thread-safe. `quality` is from 1 to 100.
std::string encode_png(const Image& image, const PngOptions& options = {});
std::string encode_jpeg(const Image& image, int quality = 92);
// Additional EXR channel with one value per pixel, row by row.
struct ExrLayer {
  std::string name;
  std::vector<float> values;
};
std::string encode_exr(const Image& image, std::span<const ExrLayer> layers = {});

// Decodes a PNG, JPEG or EXR image. The first bytes determine the format. Throws InputError if the format is
// unknown, the file is damaged, a side exceeds 65,535 pixels, or the image has more than `max_pixels` pixels.
// Not interruptible.
Image decode_image(std::span<const std::byte> bytes, std::size_t max_pixels = std::size_t{1} << 24);

}  // namespace orrery
