// Program orrery-decode: decodes one image file in a separate process with limited memory and CPU time. If a
// file crashes a library, only this process ends.

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <webp/decode.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/decoder_program.h"
#include "core/image/decode/decoder/protocol.h"
#include "core/math/elementary.h"

namespace {

using orrery::DecodedHeader;
using orrery::write_all;

[[noreturn]] void fail(std::string text) {
  constexpr std::size_t kMaxText = 500;
  text.resize(std::min(text.size(), kMaxText));
  const DecodedHeader header{static_cast<std::uint32_t>(text.size()), 0, 0, 0};
  write_all(std::as_bytes(std::span(&header, 1)));
  write_all(std::as_bytes(std::span(text)));
  std::_Exit(0);
}

// Reports an error of a library and ends the process. The report is the first line of the error text, without
// the names of libraries and of the input.
[[noreturn]] void fail_damaged(std::string text) {
  constexpr std::string_view kNames[] = {"PNG read error: ",
                                         "JPEG error: ",
                                         "OpenEXR exception: ",
                                         "Cannot read image file \"picture\". ",
                                         "Cannot read image file \"picture\"",
                                         " (\"picture\")",
                                         "\"picture\" "};
  text.resize(std::min(text.find('\n'), text.size()));
  for (const std::string_view name : kNames)
    if (const std::size_t at = text.find(name); at != text.npos) text.erase(at, name.size());
  fail("image is damaged: " + (text.empty() ? "decoder cannot read it" : text));
}

// Returns the linear light of each sRGB code (IEC 61966-2-1).
template <class Code>
std::vector<float> light_of_codes() {
  constexpr std::size_t kMaxCode = std::numeric_limits<Code>::max();
  std::vector<float> light;
  for (std::size_t code = 0; code <= kMaxCode; ++code) {
    const double x = static_cast<double>(code) / static_cast<double>(kMaxCode);
    light.push_back(
        static_cast<float>(x <= 0.04045 ? x / 12.92 : orrery::pow_unit((x + 0.055) / 1.055, 2.4)));
  }
  return light;
}

// Reads rows [begin, end) without conversion. Does not use OpenImageIO's function for several rows, because
// it always allocates 64 MiB.
template <class Sample>
void read_rows(OIIO::ImageInput& input, int begin, int end, std::vector<Sample>& samples) {
  const OIIO::ImageSpec& spec = input.spec();
  const OIIO::TypeDesc type = OIIO::BaseTypeFromC<Sample>::value;
  const std::size_t row = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
  samples.resize(row * static_cast<std::size_t>(end - begin));
  bool read = true;
  if (spec.tile_width > 0)
    read = input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end, 0, 1, 0,
                            spec.nchannels, type, samples.data());
  else
    for (int y = begin; y < end && read; ++y)
      read = input.read_scanline(spec.y + y, 0, type,
                                 samples.data() + row * static_cast<std::size_t>(y - begin));
  if (!read) fail_damaged(input.geterror());
}

// Returns the alpha of a sample, from 0 to 1.
template <class Sample>
float alpha_of(Sample sample) {
  if constexpr (std::is_floating_point_v<Sample>)
    return std::min(1.0F, std::max(0.0F, sample));  // NaN becomes 0
  else
    return static_cast<float>(static_cast<double>(sample) / std::numeric_limits<Sample>::max());
}

// Writes the header, then red, green and blue of each texel, converted by `light`, and its alpha. Grey is
// written three times.
template <class Sample>
void decode(OIIO::ImageInput& input, const auto& light) {
  const OIIO::ImageSpec& spec = input.spec();
  const bool has_alpha = spec.nchannels == 2 || spec.nchannels == 4;
  const DecodedHeader header{0, static_cast<std::uint32_t>(spec.width),
                             static_cast<std::uint32_t>(spec.height), has_alpha ? 4U : 3U};
  const int rows = spec.tile_width > 0 ? std::min(spec.tile_height, spec.height) : orrery::kRowsAtOnce;
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const bool grey = channels < 3;
  std::vector<Sample> samples;
  std::vector<float> texels;
  for (int y = 0; y < spec.height; y += rows) {
    read_rows(input, y, std::min(spec.height, y + rows), samples);
    texels.clear();
    for (std::size_t at = 0; at + channels <= samples.size(); at += channels) {
      for (std::size_t c = 0; c < 3; ++c) texels.push_back(light(samples[at + (grey ? 0 : c)]));
      if (has_alpha) texels.push_back(alpha_of(samples[at + channels - 1]));
    }
    if (y == 0) write_all(std::as_bytes(std::span(&header, 1)));
    write_all(std::as_bytes(std::span(texels)));
  }
}

template <class Code>
void decode_srgb(OIIO::ImageInput& input) {
  decode<Code>(input, [light = light_of_codes<Code>()](Code code) { return light[code]; });
}

// Decodes a WebP file. The reader of OpenImageIO would multiply colours by alpha.
void decode_webp(std::span<const std::byte> bytes) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures found;
  if (WebPGetFeatures(data, bytes.size(), &found) != VP8_STATUS_OK) fail_damaged("");
  const std::size_t channels = found.has_alpha ? 4 : 3;
  const auto stride = channels * static_cast<std::size_t>(found.width);
  std::vector<std::uint8_t> codes(stride * static_cast<std::size_t>(found.height));
  const auto decode_into = found.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!decode_into(data, bytes.size(), codes.data(), codes.size(), static_cast<int>(stride)))
    fail_damaged("");
  const DecodedHeader header{0, static_cast<std::uint32_t>(found.width),
                             static_cast<std::uint32_t>(found.height), static_cast<std::uint32_t>(channels)};
  write_all(std::as_bytes(std::span(&header, 1)));
  const std::vector<float> light = light_of_codes<std::uint8_t>();
  std::vector<float> texels(stride);
  for (std::size_t row = 0; row < codes.size(); row += stride) {
    for (std::size_t i = 0; i < stride; ++i)
      texels[i] = i % channels == 3 ? alpha_of(codes[row + i]) : light[codes[row + i]];
    write_all(std::as_bytes(std::span(texels)));
  }
}

void run(const char* plugin, std::uint64_t memory_bytes) {
  const std::span<std::byte> bytes = orrery::map_input();
  if (bytes.empty()) fail("input is missing");
  if (plugin == std::string_view("webp")) {
    orrery::limit_memory(orrery::kDecoderRoom + memory_bytes);
    return decode_webp(bytes);
  }
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::create(plugin, false, nullptr, &reader, "");
  orrery::limit_memory(orrery::kDecoderRoom +
                       memory_bytes);  // the reader's thread has started, and no byte is parsed yet
  OIIO::ImageSpec spec, how;
  how.attribute("oiio:UnassociatedAlpha", 1);
  if (!input || !input->set_ioproxy(&reader) || !input->open("picture", spec, how))
    fail_damaged(input ? input->geterror() : OIIO::geterror());
  if (spec.depth > 1 || spec.deep) fail("must be a flat image (got a deep image)");
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    fail("image is damaged: size must be at least 1 x 1");
  const std::string_view format = plugin;
  const bool linear = format == "openexr" || format == "hdr";
  if (linear)
    decode<float>(*input, [](float value) { return value; });
  else if (spec.format == OIIO::TypeDesc::UINT8)
    decode_srgb<std::uint8_t>(*input);
  else
    decode_srgb<std::uint16_t>(*input);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  constexpr rlim_t kMaxSeconds = 300;
  orrery::limit_process(kMaxSeconds);
  try {
    run(argv[1], std::strtoull(argv[2], nullptr, 10));
  } catch (const std::bad_alloc&) {
    fail("decoding needs more memory than the image size allows");
  } catch (const std::exception& error) {
    fail_damaged(error.what());
  }
  std::_Exit(0);  // skips cleanup by libraries
}
