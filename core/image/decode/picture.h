#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/shorten.h"

// core/image/decode: image files that scenes use as environments, decoded in a separate process.
//
// Threads: all functions are thread-safe.
// Errors: InputError (pointer "") for invalid files, Cancelled, std::bad_alloc, and std::system_error if the
// operating system cannot start the decoder.
namespace orrery {

// Decoded image in linear light.
struct Texels {
  int width = 0, height = 0;
  std::vector<float> rgb = {};    // red, green, blue per texel; top row first
  std::vector<float> alpha = {};  // per texel, 0 to 1; empty if the image has no alpha
  std::size_t clamped = 0;        // values of the file that were not from 0 to kMaxTexel
  bool from_srgb = false;         // the values were decoded from sRGB codes
};
using TexelsPtr = std::shared_ptr<const Texels>;

// Limits of an image file.
struct PictureLimits {
  int side = 16384;                 // texels
  std::size_t texels = 33'554'432;  // width x height; each texel takes 12 bytes
  int channels = 4;

  // Returns the error text if the size or the number of channels exceeds a limit, otherwise "".
  std::string problem_of(std::uint64_t width, std::uint64_t height, int of_channels) const {
    const auto within = [&](std::uint64_t of_side) {
      return of_side >= 1 && of_side <= static_cast<std::uint64_t>(side);
    };
    if (!within(width) || !within(height) || width * height > texels)
      return "image has " + std::to_string(width) + " x " + std::to_string(height) +
             " texels (limits: 1 to " + grouped(static_cast<std::uint64_t>(side)) +
             " per side [picture_side], " + grouped(texels) + " in total [picture_texels])";
    if (of_channels < 1 || of_channels > channels)
      return "image must have 1 to " + std::to_string(channels) + " channels (got " +
             std::to_string(of_channels) + ")";
    return {};
  }
};

// Maximum value of a channel of a texel.
inline constexpr float kMaxTexel = 1e9f;

enum class PictureFormat { exr, hdr, png, jpeg, webp };

// Returns the name of a format for messages: "EXR".
const char* name_of(PictureFormat format);

// Returns whether the first bytes of a file are the signature of a known format.
bool is_picture(std::string_view bytes);
// Returns the format of a file. Throws InputError (pointer "") if the signature is unknown.
PictureFormat picture_format(std::string_view bytes);

// Reads an OpenEXR, Radiance HDR, PNG, JPEG or WebP file. The first bytes determine the format. EXR and HDR
// are linear. PNG, JPEG and WebP are decoded from sRGB. One channel is grey. A second or fourth channel is
// alpha. The same bytes always give the same texels. The file is decoded in a separate process
// (core/image/decode/decode_process.h).
//
// The size in the header is checked before decoding. Values outside of 0 to kMaxTexel, of which there may be
// 1 %, are clamped, and NaN becomes 0. Throws InputError (pointer "") with the value and the limit, and the
// errors of decode_in_process().
Texels read_picture(std::string_view bytes, const PictureLimits& limits = {});

}  // namespace orrery
