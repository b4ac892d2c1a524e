#include "core/image/decode/picture.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/decode/decode_process.h"
#include "core/image/decode/picture_file.h"

namespace orrery {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  PictureFormat format;
  std::string_view after = {};  // bytes from byte 8
};
constexpr std::array kSignatures = {
    Signature{"\x76\x2f\x31\x01"sv, PictureFormat::exr}, Signature{"#?RADIANCE\n"sv, PictureFormat::hdr},
    Signature{"#?RGBE\n"sv, PictureFormat::hdr},         Signature{"\x89PNG\r\n\x1a\n"sv, PictureFormat::png},
    Signature{"\xff\xd8\xff"sv, PictureFormat::jpeg},    Signature{"RIFF"sv, PictureFormat::webp, "WEBP"sv}};

const Signature* signature_of(std::string_view bytes) {
  const auto found = std::find_if(kSignatures.begin(), kSignatures.end(), [&](const Signature& s) {
    return bytes.starts_with(s.bytes) &&
           (s.after.empty() || bytes.substr(std::min<std::size_t>(8, bytes.size())).starts_with(s.after));
  });
  return found == kSignatures.end() ? nullptr : &*found;
}

// Sets values outside of 0 to kMaxTexel to the nearest one inside, and NaN to 0. Throws InputError if more
// than 1 % of the values are outside: such an image is damaged.
void clamp_texels(Texels& picture) {
  const std::size_t most = picture.rgb.size() / 100;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    checkpoint(i);
    const float value = picture.rgb[i];
    if (value >= 0 && value <= kMaxTexel) continue;
    picture.rgb[i] = value > kMaxTexel ? kMaxTexel : 0;
    if (++picture.clamped <= most) continue;
    const std::size_t texel = i / 3, width = static_cast<std::size_t>(picture.width);
    char text[128];
    std::snprintf(text, sizeof text, "texels must be from 0 to %g (got %g in column %zu of row %zu, ",
                  double{kMaxTexel}, double{value}, texel % width, texel / width);
    throw InputError("", std::string(text) + "counted from 0 at the upper left, and more than 1 % in all)");
  }
}

}  // namespace

const char* name_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return "EXR";
    case PictureFormat::hdr: return "HDR";
    case PictureFormat::png: return "PNG";
    case PictureFormat::jpeg: return "JPEG";
    case PictureFormat::webp: return "WebP";
  }
  return "";
}

bool is_picture(std::string_view bytes) { return signature_of(bytes) != nullptr; }

PictureFormat picture_format(std::string_view bytes) {
  if (const Signature* const known = signature_of(bytes)) return known->format;
  throw InputError("", "must be an EXR, Radiance HDR, PNG, JPEG or WebP file (got " +
                           std::to_string(bytes.size()) + " bytes of another format)");
}

Texels read_picture(std::string_view bytes, const PictureLimits& limits) {
  const PictureFormat format = picture_format(bytes);
  try {
    Texels picture = decode_in_process(inspect_picture(bytes, format, limits));
    clamp_texels(picture);
    picture.from_srgb = format != PictureFormat::exr && format != PictureFormat::hdr;
    return picture;
  } catch (const InputError& error) {
    throw InputError("", name_of(format) + (": " + error.problems().front().detail));
  }
}

}  // namespace orrery
