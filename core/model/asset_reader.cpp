#include "core/model/asset_reader.h"

namespace orrery {
namespace {

constexpr std::int64_t kMaxImage = 1'000'000;  // images of a file have smaller numbers

// Reads the number of an image in a model file. Returns nullopt if the file is an image.
std::optional<std::size_t> read_image_number(Params& p) {
  const std::int64_t number =
      p.integer("image", "Number of an image in a model file, from 0; default: the file is an image.", 0,
                kMaxImage, derived(std::int64_t{0}));
  return p.has("image") ? std::optional(static_cast<std::size_t>(number)) : std::nullopt;
}

TexelsPtr image_of(const MeshModel& model, std::size_t number) {
  if (number >= model.images.size())
    throw InputError("", "must be a model with more than " + std::to_string(number) +
                             " images that its materials use, as \"image\" states (got " +
                             std::to_string(model.images.size()) + ")");
  const ModelImage& image = model.images[number];
  try {
    return std::make_shared<const Texels>(read_picture(*image.bytes));
  } catch (const InputError& error) {
    throw InputError("", image.name + ": " + error.problems().front().detail);
  }
}

}  // namespace

TexelsPtr read_picture(Params& p, const AssetSource& source) {
  if (p.form({{"file"}, {"asset"}}) == 0) {
    const std::string name =
        p.text("file", "EXR, HDR, PNG, JPEG or WebP file in or below the scene's folder; command line only.",
               kMostNameLength);
    const auto image = read_image_number(p);
    return read_named(p, "file", name, [&](const std::string& n) {
      return image ? image_of(*source.model_file(n), *image) : source.picture_file(n);
    });
  }
  const std::string name = p.text("asset", "SHA-256 of an uploaded EXR, HDR, PNG, JPEG or WebP file.", 64);
  const auto image = read_image_number(p);
  return read_named(p, "asset", name, [&](const std::string& n) {
    return image ? image_of(*source.model_asset(n), *image) : source.picture_asset(n);
  });
}

}  // namespace orrery
