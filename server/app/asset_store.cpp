#include "server/app/asset_store.h"

#include <algorithm>
#include <utility>

#include "core/base/hash.h"

namespace orrery {

namespace {

std::size_t bytes_of(const Texels& picture) { return picture.rgb.size() * sizeof(float); }

// Keeps the texels of a picture that takes at most `most_texel_bytes`.
decltype(AssetStore::Asset::content) content_of(const std::string& bytes, std::size_t most_texel_bytes) {
  if (is_picture(bytes)) {
    auto texels = std::make_shared<const Texels>(read_picture(bytes));
    const auto [width, height] = std::pair(texels->width, texels->height);
    if (bytes_of(*texels) > most_texel_bytes) texels = nullptr;
    return AssetStore::Asset::Picture{picture_format(bytes), width, height, std::move(texels)};
  }
  const TriangleMesh mesh = read_mesh(bytes);
  return AssetStore::Asset::Mesh{mesh_format(bytes), mesh.positions.size(), mesh.triangles.size()};
}

}  // namespace

void AssetStore::require_name(const std::string& name) {
  if (!is_sha256_hex(name))
    throw InputError(
        "", "an asset is named by the SHA-256 of its bytes: 64 digits 0-9, a-f; got " + name.substr(0, 80));
}

AssetStore::Added AssetStore::add(const std::string& sha256, std::string bytes) {
  const std::string hash = sha256_hex(bytes);
  if (hash != sha256)
    throw InputError("",
                     "the SHA-256 of these bytes is " + hash + ", which must be the name they are put under");
  if (const auto known = assets_.find(sha256)) return {*known, true};
  constexpr std::size_t kEntry = 512;  // bytes of an entry besides those of its file
  std::size_t size = bytes.size() + kEntry;
  if (size > assets_.most_bytes())
    throw InputError("", "the file takes " + std::to_string(size) + " bytes of memory, at most " +
                             std::to_string(assets_.most_bytes()) + " are kept (asset_store_bytes)");
  auto asset = std::make_shared<Asset>();
  // So that one picture does not evict most of the others.
  const std::size_t most_texel_bytes = std::min(assets_.most_bytes() / 4, assets_.most_bytes() - size);
  asset->content = content_of(bytes, most_texel_bytes);
  if (const auto* const picture = std::get_if<Asset::Picture>(&asset->content); picture && picture->texels)
    size += bytes_of(*picture->texels);
  asset->bytes = std::move(bytes);
  const auto added = assets_.add(sha256, size, [&asset] { return asset; });
  return {added.value, added.known};
}

AssetStore::AssetPtr AssetStore::find(const std::string& sha256) {
  const auto found = assets_.find(sha256);
  if (!found) throw NotFound("There is no asset " + sha256.substr(0, 64) + " (any more): put it again");
  return *found;
}

void AssetStore::remove(const std::string& sha256) {
  if (!assets_.remove(sha256)) throw NotFound("There is no asset " + sha256.substr(0, 64));
}

AssetStore::AssetPtr AssetStore::find_for_scene(const std::string& sha256) const {
  require_name(sha256);
  const auto found = assets_.find(sha256);
  if (!found)
    throw InputError("", "there is no asset " + sha256 + " (any more): put it to /v1/assets/" + sha256);
  return *found;
}

TriangleMesh AssetStore::mesh_asset(const std::string& sha256) const {
  return read_mesh(find_for_scene(sha256)->bytes);
}

TexelsPtr AssetStore::picture_asset(const std::string& sha256) const {
  const AssetPtr asset = find_for_scene(sha256);
  const auto* const picture = std::get_if<Asset::Picture>(&asset->content);
  if (picture && picture->texels) return picture->texels;
  return std::make_shared<const Texels>(read_picture(asset->bytes));
}

}  // namespace orrery
