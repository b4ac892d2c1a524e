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

PictureName read_picture_name(Params& p) {
  const bool is_file = p.form({{"file"}, {"asset"}}) == 0;
  std::string name =
      is_file ? p.text("file",
                       "EXR, HDR, PNG, JPEG or WebP file in or below the scene's folder; command line only.",
                       kMostNameLength)
              : p.text("asset", "SHA-256 of an uploaded EXR, HDR, PNG, JPEG or WebP file.", 64);
  return {is_file ? "file" : "asset", std::move(name), read_image_number(p)};
}

TexelsPtr picture_of(const AssetSource& source, const PictureName& name) {
  const bool is_file = name.key == std::string_view("file");
  if (name.image)
    return image_of(*(is_file ? source.model_file(name.name) : source.model_asset(name.name)), *name.image);
  return is_file ? source.picture_file(name.name) : source.picture_asset(name.name);
}

TexelsPtr read_picture(Params& p, const AssetSource& source) {
  const PictureName name = read_picture_name(p);
  return read_named(p, name.key, name.name, [&](const std::string&) { return picture_of(source, name); });
}

}  // namespace orrery
