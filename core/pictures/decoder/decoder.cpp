#include "core/pictures/decoder/decoder.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <span>

namespace {

using orrery::PictureFormat;
using orrery::PictureLimits;
using orrery::Texels;

const char* plugin_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return "openexr";
    case PictureFormat::hdr: return "hdr";
    case PictureFormat::png: return "png";
    case PictureFormat::jpeg: return "jpeg";
  }
  return "";
}

std::string problem_of(const OIIO::ImageSpec& spec, const PictureLimits& limits) {
  if (spec.depth > 1 || spec.deep) return "expected a flat picture, got one with depth";
  const auto side = [](int texels) { return static_cast<std::uint64_t>(std::max(0, texels)); };
  return limits.problem_of(side(spec.width), side(spec.height), spec.nchannels);
}

// Red, green and blue of texels with `channels` values each; grey is all three.
void spread(std::span<const float> values, int channels, std::vector<float>& rgb) {
  const bool grey = channels < 3;
  const auto step = static_cast<std::size_t>(channels);
  for (std::size_t at = 0; at + step <= values.size(); at += step)
    for (std::size_t c = 0; c < 3; ++c) rgb.push_back(values[at + (grey ? 0 : c)]);
}

// Some rows at a time, so that beside the picture little is held and a stop is seen soon.
std::string decode(OIIO::ImageInput& input, bool (*stopped)(), Texels& picture) {
  const OIIO::ImageSpec& spec = input.spec();
  const auto width = static_cast<std::size_t>(spec.width), height = static_cast<std::size_t>(spec.height);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  // Tiled files are read by whole rows of tiles.
  const int rows = spec.tile_height > 0 ? std::min(spec.tile_height, spec.height) : 64;
  picture.rgb.reserve(3 * width * height);
  std::vector<float> band;
  for (int y = 0; y < spec.height; y += rows) {
    if (stopped()) return "reading was stopped";
    const int end = std::min(spec.height, y + rows);
    band.resize(width * channels * static_cast<std::size_t>(end - y));
    const bool read = spec.tile_width > 0
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + end, 0,
                                             1, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, band.data())
                          : input.read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, spec.nchannels,
                                                 OIIO::TypeDesc::FLOAT, band.data());
    if (!read) return "the picture is damaged: " + input.geterror();
    spread(band, spec.nchannels, picture.rgb);
  }
  picture.width = spec.width;
  picture.height = spec.height;
  return {};
}

}  // namespace

extern "C" void orrery_decode_picture(std::string_view bytes, PictureFormat format,
                                      const PictureLimits& limits, bool (*stopped)(), Texels& picture,
                                      std::string& problem) {
  OIIO::attribute("threads", 1);  // this thread alone, whose memory is counted
  OIIO::attribute("exr_threads", -1);
  OIIO::Filesystem::IOMemReader reader(const_cast<char*>(bytes.data()), bytes.size());
  const auto input = OIIO::ImageInput::create(plugin_of(format), false, nullptr, &reader, "");
  OIIO::ImageSpec spec, how;
  how.attribute("oiio:UnassociatedAlpha", 1);
  if (!input || !input->set_ioproxy(&reader) || !input->open("picture", spec, how)) {
    problem = "the picture is damaged: " + (input ? input->geterror() : OIIO::geterror());
    return;
  }
  problem = problem_of(spec, limits);
  if (problem.empty()) problem = decode(*input, stopped, picture);
}
