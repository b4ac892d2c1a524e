#include "core/image/decode/decode_process.h"

#include <algorithm>
#include <span>

#include "core/base/decoder_process.h"
#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/decode/decoder/protocol.h"

namespace orrery {
namespace {

const char* plugin_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return "openexr";
    case PictureFormat::hdr: return "hdr";
    case PictureFormat::png: return "png";
    case PictureFormat::jpeg: return "jpeg";
    case PictureFormat::webp: return "webp";
  }
  return "";
}

// Returns the bytes that the process may allocate in addition to kDecoderBytes.
std::uint64_t allowance(const PictureFile& file) {
  const std::uint64_t rows = std::min<std::uint64_t>(file.height, kRowsAtOnce), samples = 2, sample_bytes = 4;
  return file.decoder_bytes + samples * sample_bytes * file.width * rows * 4;
}

// Reads texels with alpha by read(values), which fills a list, and separates the alpha.
template <class Read>
void read_with_alpha(const Read& read, Texels& picture) {
  constexpr std::size_t kAtOnce = 16384;  // texels
  picture.alpha.resize(picture.rgb.size() / 3);
  std::vector<float> values;
  for (std::size_t at = 0; at < picture.alpha.size(); at += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, picture.alpha.size() - at);
    values.resize(4 * count);
    read(values);
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(&values[4 * i], 3, &picture.rgb[3 * (at + i)]);
      picture.alpha[at + i] = values[4 * i + 3];
    }
  }
}

}  // namespace

Texels decode_in_process(const PictureFile& file) {
  const MemoryCharge charge(kDecoderBytes + allowance(file));
  DecoderProcess decoder("orrery-decode", {plugin_of(file.format), std::to_string(allowance(file))},
                         file.parts, "image");
  DecodedHeader header{};
  decoder.read_all(std::as_writable_bytes(std::span(&header, 1)));
  if (header.text_bytes > 0) decoder.fail_with_text(header.text_bytes);
  if (header.width != file.width || header.height != file.height)
    throw InputError("", "image is damaged: decoded size must equal the size in the header, " +
                             std::to_string(file.width) + " x " + std::to_string(file.height) + " (got " +
                             std::to_string(header.width) + " x " + std::to_string(header.height) + ")");
  Texels picture{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}};
  picture.rgb.resize(std::size_t{3} * header.width * header.height);
  const auto read = [&](std::span<float> values) { decoder.read_all(std::as_writable_bytes(values)); };
  if (header.channels == 3)
    read(picture.rgb);
  else
    read_with_alpha(read, picture);
  return picture;
}

}  // namespace orrery
