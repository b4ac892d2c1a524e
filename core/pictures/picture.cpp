#include "core/pictures/picture.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/work_scope.h"
#include "core/math/elementary.h"
#include "core/pictures/decoder/decoder.h"

namespace orrery {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  PictureFormat format;
};
constexpr std::array kSignatures = {
    Signature{"\x76\x2f\x31\x01"sv, PictureFormat::exr}, Signature{"#?RADIANCE\n"sv, PictureFormat::hdr},
    Signature{"#?RGBE\n"sv, PictureFormat::hdr}, Signature{"\x89PNG\r\n\x1a\n"sv, PictureFormat::png},
    Signature{"\xff\xd8\xff"sv, PictureFormat::jpeg}};

const Signature* signature_of(std::string_view bytes) {
  const auto found = std::find_if(kSignatures.begin(), kSignatures.end(),
                                  [&](const Signature& s) { return bytes.starts_with(s.bytes); });
  return found == kSignatures.end() ? nullptr : &*found;
}

// Looked for along the run path, so beside the executable; stays open until the process ends.
OrreryDecodePicture* decoder() {
  static OrreryDecodePicture* const found = [] {
    void* const library = dlopen("liborrery_pictures.so", RTLD_NOW | RTLD_LOCAL);
    void* const symbol = library ? dlsym(library, "orrery_decode_picture") : nullptr;
    if (!symbol) throw InputError("", std::string("no pictures can be read here: ") + dlerror());
    return reinterpret_cast<OrreryDecodePicture*>(symbol);
  }();
  return found;
}

// Whether the work is to end; interruption_point() throws why afterwards.
bool is_stopped() {
  try {
    interruption_point();
    return false;
  } catch (...) {
    return true;
  }
}

constexpr const char* kNoEnd = "the picture is damaged: it has no end";

// What is wrong with a JPEG file that libjpeg would not notice, or only after it has taken memory and time:
// it makes up what is missing, and decodes all scans of a progressive file, at its whole size, as it opens
// it. Before the scans are segments that tell their length, one of which is the frame: precision, height,
// width and components; in a scan a marker's first byte is never followed by its second.
std::string problem_of_jpeg(std::string_view bytes, const PictureLimits& limits) {
  constexpr unsigned kMarker = 0xff, kScan = 0xda, kFirstFrame = 0xc0, kLastFrame = 0xcf;
  constexpr int kMostScans = 256;  // usual are 10
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u;
  };
  const auto word = [&](std::size_t i) { return byte(i) * 256 + byte(i + 1); };
  unsigned width = 0, height = 0, components = 0;
  std::size_t at = 2;
  for (; at + 4 <= bytes.size() && byte(at) == kMarker && byte(at + 1) != kScan;
       at += byte(at + 1) == kMarker ? 1 : 2 + word(at + 2)) {
    const unsigned marker = byte(at + 1);
    const bool no_frame = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;  // tables and extensions
    if (marker < kFirstFrame || marker > kLastFrame || no_frame) continue;
    height = word(at + 5);
    width = word(at + 7);
    components = byte(at + 9);
  }
  if (at >= bytes.size() || bytes.find("\xff\xd9"sv, at) == std::string_view::npos) return kNoEnd;
  if (components == 0) return "the picture is damaged: it has no size before its scans";
  if (std::string problem = limits.problem_of(width, height, static_cast<int>(components)); !problem.empty())
    return problem;
  int scans = 0;
  for (; at != std::string_view::npos; at = bytes.find("\xff\xda"sv, at + 2)) ++scans;
  if (scans <= kMostScans) return {};
  return "expected at most " + std::to_string(kMostScans) + " scans, got " + std::to_string(scans);
}

// Whether the chunks of a PNG file, each of a length, a type, so many bytes and a checksum, lead to the last
// one within the file: OpenImageIO loses memory where libpng asks it for bytes beyond the end.
bool has_png_end(std::string_view bytes) {
  constexpr std::size_t kSignature = 8, kFrame = 12;
  std::size_t at = kSignature;
  while (bytes.size() - at >= kFrame) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length * 256 + static_cast<unsigned char>(bytes[at + i]);
    if (length > bytes.size() - at - kFrame) return false;
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += kFrame + length;
  }
  return false;
}

// What a decoder does not notice, or not in time or without harm.
std::string problem_before_decoding(std::string_view bytes, PictureFormat format,
                                    const PictureLimits& limits) {
  if (format == PictureFormat::jpeg) return problem_of_jpeg(bytes, limits);
  return format == PictureFormat::png && !has_png_end(bytes) ? kNoEnd : "";
}

// IEC 61966-2-1.
float linear_of_srgb(float encoded) {
  const double x = std::clamp(double{encoded}, 0.0, 1.0);
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : pow_unit((x + 0.055) / 1.055, 2.4));
}

void check_texels(const Texels& picture) {
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    interruption_point(i);
    const float value = picture.rgb[i];
    if (value >= 0 && value <= kMaxTexel) continue;
    const std::size_t texel = i / 3, width = static_cast<std::size_t>(picture.width);
    char text[128];
    std::snprintf(text, sizeof text, "expected texels of 0 to %g, got %g in column %zu of row %zu",
                  double{kMaxTexel}, double{value}, texel % width, texel / width);
    throw InputError("", std::string(text) + " (counted from 0 at the upper left)");
  }
}

}  // namespace

const char* name_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return "EXR";
    case PictureFormat::hdr: return "HDR";
    case PictureFormat::png: return "PNG";
    case PictureFormat::jpeg: return "JPEG";
  }
  return "";
}

bool is_picture(std::string_view bytes) { return signature_of(bytes) != nullptr; }

PictureFormat picture_format(std::string_view bytes) {
  if (const Signature* const known = signature_of(bytes)) return known->format;
  throw InputError("", "expected an EXR, Radiance HDR, PNG or JPEG file, got " +
                           std::to_string(bytes.size()) + " bytes of another kind");
}

Texels read_picture(std::string_view bytes, const PictureLimits& limits) {
  const PictureFormat format = picture_format(bytes);
  Texels picture;
  std::string problem = problem_before_decoding(bytes, format, limits);
  if (problem.empty()) decoder()(bytes, format, limits, is_stopped, picture, problem);
  interruption_point();
  if (!problem.empty()) throw InputError("", name_of(format) + (": " + problem));
  if (format == PictureFormat::png || format == PictureFormat::jpeg)
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
      interruption_point(i);
      picture.rgb[i] = linear_of_srgb(picture.rgb[i]);
    }
  check_texels(picture);
  return picture;
}

}  // namespace orrery
