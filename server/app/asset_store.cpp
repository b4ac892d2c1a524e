#include "server/app/asset_store.h"

#include <algorithm>
#include <utility>

#include "core/base/hash.h"
#include "server/http/limit_exceeded.h"
#include "server/http/message.h"

namespace orrery {

namespace {

std::size_t bytes_of(const Texels& picture) { return picture.rgb.size() * sizeof(float); }

std::size_t bytes_of(const AssetStore::Asset& asset) {
  constexpr std::size_t kEntry = 1024;  // overhead of an entry
  const auto* const picture = std::get_if<AssetStore::Asset::Picture>(&asset.content);
  return kEntry + asset.bytes.size() + (picture && picture->texels ? bytes_of(*picture->texels) : 0);
}

// Parses the file. Keeps the texels of an image if they take at most `max_texel_bytes`.
decltype(AssetStore::Asset::content) content_of(const std::string& bytes, std::size_t max_texel_bytes) {
  if (is_picture(bytes)) {
    auto texels = std::make_shared<const Texels>(read_picture(bytes));
    const auto [width, height] = std::pair(texels->width, texels->height);
    if (bytes_of(*texels) > max_texel_bytes) texels = nullptr;
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

AssetStore::AddResult AssetStore::add(const std::string& sha256, std::string bytes,
                                      const std::string& client) {
  const std::string hash = sha256_hex(bytes);
  if (hash != sha256)
    throw InputError("",
                     "the SHA-256 of these bytes is " + hash + ", which must be the name they are put under");
  if (const auto known = assets_.find(sha256)) {
    assets_.add(sha256, client, bytes_of(**known), [&] { return *known; });
    return {*known, true};
  }
  auto asset = std::make_shared<Asset>();
  asset->bytes = std::move(bytes);
  const std::size_t most = assets_.max_bytes(), least = bytes_of(*asset);
  if (least > most)
    throw InputError("", "the file takes " + std::to_string(least) + " bytes of memory, at most " +
                             std::to_string(most) + " are kept (asset_store_bytes)");
  // Limits texels to a quarter of the store, so that one image does not evict most others.
  asset->content = content_of(asset->bytes, std::min(most / 4, most - least));
  const auto add = [&] { return assets_.add(sha256, client, bytes_of(*asset), [&] { return asset; }); };
  auto added = add();
  auto* const picture = std::get_if<Asset::Picture>(&asset->content);
  if (!added && picture && picture->texels) {
    picture->texels = nullptr;
    added = add();
  }
  if (added) return {added->value, added->known};
  constexpr double kRetry_s = 30;
  throw LimitExceeded("Assets of others leave no room for " + std::to_string(least) +
                          " bytes more of yours, of " + std::to_string(most) + " for all (asset_store_bytes)",
                      kRetry_s, "asset_store_bytes");
}

AssetStore::AssetPtr AssetStore::find(const std::string& sha256) {
  const auto found = assets_.find(sha256);
  if (!found) throw NotFound("There is no asset " + sha256.substr(0, 64) + " (any more): put it again");
  return *found;
}

void AssetStore::remove(const std::string& sha256, const std::string& client, bool of_all) {
  switch (assets_.remove(sha256, client, of_all)) {
    case Lru<AssetPtr>::Removed::yes: return;
    case Lru<AssetPtr>::Removed::unknown: throw NotFound("There is no asset " + sha256.substr(0, 64));
    case Lru<AssetPtr>::Removed::not_held:
      throw HttpError(403,
                      "An asset is removed by a client that has put it, or by a token of the scope admin");
  }
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
