#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/model/asset_source.h"
#include "core/plan/limits.h"

namespace orrery {

// Asset source that loads each mesh and image once, even if the scene names it several times. Limits the
// texels of all textures together. Not thread-safe.
class CachedAssetSource final : public AssetSource {
 public:
  // `max_texels`: limit of the sum of width x height of different images of textures.
  explicit CachedAssetSource(const AssetSource& from, std::size_t max_texels = kMaxTextureTexels)
      : from_(from), max_texels_(max_texels) {}

  MeshModelPtr model_file(const std::string& name, const ModelState& state) const override;
  MeshModelPtr model_asset(const std::string& sha256, const ModelState& state) const override;
  TexelsPtr picture_file(const std::string& name) const override;
  TexelsPtr picture_asset(const std::string& sha256) const override;
  // Throws InputError for the image that exceeds the limit, and returns null for further ones.
  ImageLevelsPtr levels(const std::string& key, const std::function<ImageLevelsPtr()>& make) const override;

  // Returns notes about images.
  std::vector<Problem> take_notes() const { return std::move(notes_); }

 private:
  using ModelKey = std::pair<std::string, ModelState>;

  TexelsPtr noted(const std::string& name, TexelsPtr texels) const;

  const AssetSource& from_;
  const std::size_t max_texels_;
  mutable std::size_t texels_ = 0;
  mutable std::vector<Problem> notes_;
  mutable std::map<ModelKey, MeshModelPtr> files_, assets_;
  mutable std::map<std::string, TexelsPtr> picture_files_, picture_assets_;
  mutable std::map<std::string, ImageLevelsPtr> levels_;
};

}  // namespace orrery
