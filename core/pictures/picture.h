#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Linear light of an image file.
struct Texels {
  int width = 0, height = 0;
  std::vector<float> rgb;  // red, green and blue of each texel, row by row from the top
};
using TexelsPtr = std::shared_ptr<const Texels>;

// What an image file may hold.
struct PictureLimits {
  int side = 16384;                 // texels
  std::size_t texels = 33'554'432;  // in all; each takes 12 bytes
  int channels = 4;

  // Empty if a picture of that size is within the limits.
  std::string problem_of(std::uint64_t width, std::uint64_t height, int of_channels) const {
    const auto within = [&](std::uint64_t of_side) {
      return of_side >= 1 && of_side <= static_cast<std::uint64_t>(side);
    };
    if (!within(width) || !within(height) || width * height > texels)
      return "expected a picture of 1 to " + std::to_string(side) + " texels a side and at most " +
             std::to_string(texels) + " in all, got " + std::to_string(width) + " x " +
             std::to_string(height);
    if (of_channels < 1 || of_channels > channels)
      return "expected a picture of 1 to " + std::to_string(channels) + " channels, got " +
             std::to_string(of_channels);
    return {};
  }
};

// Largest value of a texel.
inline constexpr float kMaxTexel = 1e9f;

enum class PictureFormat { exr, hdr, png, jpeg };

// As people write it: "EXR".
const char* name_of(PictureFormat format);

// The format of a file, told by its first bytes; none if it is of no such format.
bool is_picture(std::string_view bytes);
// Throws InputError (pointer "") if it is none.
PictureFormat picture_format(std::string_view bytes);

// Reads an OpenEXR, Radiance HDR, PNG or JPEG file; its first bytes say which. EXR and HDR are linear; PNG
// and JPEG are decoded from sRGB. One channel is grey; a second or fourth, alpha, is left out. The same bytes
// give the same picture. The file is decoded in a process of its own (core/pictures/decode_process.h).
//
// Throws InputError (pointer "") with the value and the limit; Cancelled; std::bad_alloc. The size that a
// file states is checked before anything is decoded. Texels must be finite, at least 0 and at most kMaxTexel.
Texels read_picture(std::string_view bytes, const PictureLimits& limits = {});

}  // namespace orrery
