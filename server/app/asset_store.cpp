#include "server/app/asset_store.h"

#include "core/base/hash.h"

namespace orrery {

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
  constexpr std::size_t kEntry = 512;  // what a file takes in memory beside its bytes
  const std::size_t size = bytes.size() + kEntry;
  if (size > assets_.most_bytes())
    throw InputError("", "the file takes " + std::to_string(size) + " bytes of memory, at most " +
                             std::to_string(assets_.most_bytes()) + " are kept (asset_store_bytes)");
  const TriangleMesh mesh = read_mesh(bytes);
  auto asset = std::make_shared<Asset>();
  asset->format = mesh_format(bytes);
  asset->vertices = mesh.positions.size();
  asset->triangles = mesh.triangles.size();
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

TriangleMesh AssetStore::asset(const std::string& sha256) const {
  require_name(sha256);
  const auto found = assets_.find(sha256);
  if (!found)
    throw InputError("", "there is no asset " + sha256 + " (any more): put it to /v1/assets/" + sha256);
  return read_mesh((*found)->bytes);
}

}  // namespace orrery
