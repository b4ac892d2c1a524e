#pragma once

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/encode/files.h"

// Shared helpers of the image codecs. Decoders check the size in the header before they decode the pixels.
// They throw InputError if the image is damaged or too large.
namespace orrery {

Image decode_png(std::span<const std::byte> bytes, std::size_t max_pixels);
Image decode_jpeg(std::span<const std::byte> bytes, std::size_t max_pixels);
Image decode_exr(std::span<const std::byte> bytes, std::size_t max_pixels);

inline InputError damaged(const char* format, const char* why) {
  return InputError("", std::string(format) + ": image is damaged: " + why);
}

inline void check_size(std::size_t width, std::size_t height, std::size_t max_pixels) {
  constexpr std::size_t kMaxSide = 65535;
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide || width * height > max_pixels)
    throw InputError("", "image must have 1 to " + std::to_string(kMaxSide) + " pixels per side, at most " +
                             std::to_string(max_pixels) + " in total (got " + std::to_string(width) + " x " +
                             std::to_string(height) + ")");
}

}  // namespace orrery
