#include "core/render/views.h"

#include "core/base/error.h"
#include "core/plan/options.h"

namespace orrery {
namespace {

// Calls use(image) with the film's radiance in `format`. Converts only if the film has another format.
template <class Use>
std::string with_image(const Film& film, PixelFormat format, const Use& use) {
  const bool kept = film.storage() != FilmStorage::sums && film.stored().format() == format;
  return kept ? use(film.stored()) : use(film.image(format));
}

std::vector<ExrLayer> layers_of(const Film& film) {
  std::vector<ExrLayer> layers;
  for (std::size_t channel = 0; channel < film.channels().size(); ++channel) {
    const ChannelType& type = *film.channels()[channel];
    for (std::size_t c = 0; c < type.components.size(); ++c)
      layers.push_back({std::string(type.name) + "." + type.components[c], film.values(channel, c)});
  }
  return layers;
}

}  // namespace

FilmStorage storage_for(FileFormat format, const Plan& plan) {
  if (format != FileFormat::exr) return FilmStorage::srgb8;
  return plan.channels.empty() ? FilmStorage::linear32 : FilmStorage::sums;
}

void require_layers_kept(const RenderRequest& request, FileFormat format) {
  if (format != FileFormat::exr && request.layers && !request.layers->empty())
    throw InputError("/render/layers", format == FileFormat::png
                                           ? "cannot be used with PNG (only EXR stores layers); use EXR"
                                           : "cannot be used with JPEG (only EXR stores layers); use EXR");
}

void choose_space(RenderRequest& request, FileFormat format) {
  if (format == FileFormat::jpeg && request.error.value_or(0) > 0)
    throw InputError("/budget/max_error",
                     "cannot be used with JPEG (compression error is unbounded); use PNG or EXR");
  if (has_budget(request)) require_picture(request, "a budget");
  const bool open = request.space.value_or(Space::automatic) == Space::automatic;
  if (open && has_budget(request) && format == FileFormat::png) request.space = Space::display;
}

std::string encode_film(const Film& film, FileFormat format, const PngOptions& png) {
  switch (format) {
    case FileFormat::png:
      return with_image(film, PixelFormat::srgb8, [&](const Image& i) { return encode_png(i, png); });
    case FileFormat::jpeg:
      return with_image(film, PixelFormat::srgb8, [](const Image& i) { return encode_jpeg(i); });
    case FileFormat::exr:
      return with_image(film, PixelFormat::linear32,
                        [&](const Image& i) { return encode_exr(i, layers_of(film)); });
  }
  return {};
}

}  // namespace orrery
