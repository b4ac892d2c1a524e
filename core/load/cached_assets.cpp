#include "core/load/cached_assets.h"

#include "core/base/shorten.h"
#include "core/textures/image_map.h"

namespace orrery {
namespace {

template <class Name, class Asset, class Read>
const Asset& once(std::map<Name, Asset>& assets, const std::type_identity_t<Name>& name, const Read& read) {
  const auto known = assets.find(name);
  return known != assets.end() ? known->second : assets.emplace(name, read()).first->second;
}

// Textures use the images of models in the default state. Other states need none, and a model may have many.
MeshModelPtr images_if_needed(MeshModelPtr model, const ModelState& state) {
  return state == ModelState() ? model : without_images(std::move(model));
}

}  // namespace

MeshModelPtr CachedAssetSource::model_file(const std::string& name, const ModelState& state) const {
  return once(files_, {name, state}, [&] { return images_if_needed(from_.model_file(name, state), state); });
}

MeshModelPtr CachedAssetSource::model_asset(const std::string& sha256, const ModelState& state) const {
  return once(assets_, {sha256, state},
              [&] { return images_if_needed(from_.model_asset(sha256, state), state); });
}

TexelsPtr CachedAssetSource::picture_file(const std::string& name) const {
  return once(picture_files_, name, [&] { return noted(name, from_.picture_file(name)); });
}

TexelsPtr CachedAssetSource::picture_asset(const std::string& sha256) const {
  return once(picture_assets_, sha256, [&] { return noted(sha256, from_.picture_asset(sha256)); });
}

ImageLevelsPtr CachedAssetSource::levels(const std::string& key,
                                         const std::function<ImageLevelsPtr()>& make) const {
  if (texels_ > max_texels_) return nullptr;
  return once(levels_, key, [&] {
    ImageLevelsPtr made = make();
    texels_ += made->texels();
    if (texels_ > max_texels_)
      throw InputError("", "images of textures have more than " + grouped(max_texels_) + " texels (limit " +
                               grouped(max_texels_) + ", texture_texels)");
    return made;
  });
}

TexelsPtr CachedAssetSource::noted(const std::string& name, TexelsPtr texels) const {
  if (texels && texels->clamped > 0)
    notes_.push_back({"", "image " + shortened(name, 80) + " has " + grouped(texels->clamped) +
                              " values that are negative, too large or no numbers, which were clamped"});
  return texels;
}

}  // namespace orrery
