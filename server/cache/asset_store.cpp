#include "server/cache/asset_store.h"

#include <algorithm>
#include <utility>

#include "core/base/hash.h"
#include "core/base/shorten.h"
#include "core/meshes/zip_file.h"
#include "core/model/model_images.h"
#include "server/base/errors.h"

namespace orrery {

namespace {

std::size_t bytes_of(const Texels& picture) {
  return (picture.rgb.size() + picture.alpha.size()) * sizeof(float);
}

std::size_t bytes_of(const AssetStore::Asset& asset) {
  constexpr std::size_t kEntry = 1024;  // overhead of an entry in bytes
  std::size_t sum = kEntry + asset.bytes.size();
  if (const auto* const mesh = std::get_if<AssetStore::Asset::Mesh>(&asset.content))
    for (const std::string& note : mesh->notes) sum += sizeof note + note.size();
  const auto* const picture = std::get_if<AssetStore::Asset::Picture>(&asset.content);
  return sum + (picture && picture->texels ? bytes_of(*picture->texels) : 0);
}

// Throws InputError that lists the mesh and image formats if the file has none of the mesh formats, since an
// upload may be either.
void require_mesh_format(const std::string& bytes) {
  try {
    if (!ZipFile::is_zip(bytes)) mesh_format(bytes);
  } catch (const InputError& error) {
    throw InputError(
        "", error.problems().front().detail + "; an image must be an EXR, HDR, PNG, JPEG or WebP file");
  }
}

// Parses the file. Keeps the texels of an image if they take at most `max_texel_bytes`.
decltype(AssetStore::Asset::content) content_of(const std::string& bytes, std::size_t max_texel_bytes) {
  if (is_picture(bytes)) {
    auto texels = std::make_shared<const Texels>(read_picture(bytes));
    const auto [width, height] = std::pair(texels->width, texels->height);
    if (bytes_of(*texels) > max_texel_bytes) texels = nullptr;
    return AssetStore::Asset::Picture{picture_format(bytes), width, height, std::move(texels)};
  }
  require_mesh_format(bytes);
  const MeshModel model = read_model(bytes);
  const TriangleMesh& mesh = model.mesh;
  return AssetStore::Asset::Mesh{model.format, mesh.positions.size(), mesh.triangles.size(), notes_of(model)};
}

}  // namespace

void AssetStore::require_name(const std::string& name) {
  if (!is_sha256_hex(name))
    throw InputError("", "asset name must be the SHA-256 of the file, 64 digits 0-9 or a-f (got " +
                             name.substr(0, 80) + ")");
}

AssetStore::AddResult AssetStore::add(const std::string& sha256, std::string bytes,
                                      const std::string& client) {
  const std::string hash = sha256_hex(bytes);
  if (!sha256.empty() && hash != sha256)
    throw InputError("", "asset name must be the SHA-256 of the file, " + hash + " (got " + sha256 + ")");
  if (const auto known = assets_.find(hash)) {
    assets_.add(hash, client, bytes_of(**known), [&] { return *known; });
    return {hash, *known, true};
  }
  auto asset = std::make_shared<Asset>();
  asset->bytes = std::move(bytes);
  const std::size_t most = assets_.max_bytes(), least = bytes_of(*asset);
  if (least > most)
    throw InputError("", "file takes " + grouped(least) + " bytes of memory (limit " + grouped(most) +
                             ", asset_store_bytes)");
  // Limits texels to a quarter of the store, so that one image does not evict most others.
  asset->content = content_of(asset->bytes, std::min(most / 4, most - least));
  const auto add = [&] { return assets_.add(hash, client, bytes_of(*asset), [&] { return asset; }); };
  auto added = add();
  auto* const picture = std::get_if<Asset::Picture>(&asset->content);
  if (!added && picture && picture->texels) {
    picture->texels = nullptr;
    added = add();
  }
  if (added) return {hash, added->value, added->known};
  constexpr double kRetry_s = 30;
  throw LimitExceeded("assets of other clients leave no room for " + grouped(least) + " more bytes (limit " +
                          grouped(most) + ", asset_store_bytes)",
                      kRetry_s, "asset_store_bytes");
}

AssetStore::AssetPtr AssetStore::find(const std::string& sha256) {
  const auto found = assets_.find(sha256);
  if (!found)
    throw NotFound("unknown asset " + sha256.substr(0, 64) + " (it may have been evicted; upload it again)");
  return *found;
}

void AssetStore::remove(const std::string& sha256, const std::string& client, bool of_all) {
  switch (assets_.remove(sha256, client, of_all)) {
    case Lru<AssetPtr>::Removed::yes: return;
    case Lru<AssetPtr>::Removed::unknown: throw NotFound("unknown asset " + sha256.substr(0, 64));
    case Lru<AssetPtr>::Removed::not_held:
      throw Forbidden(
          "asset can be removed only by a client that uploaded it or with a token of scope admin");
  }
}

AssetStore::AssetPtr AssetStore::find_for_scene(const std::string& sha256) const {
  require_name(sha256);
  const auto found = assets_.find(sha256);
  if (!found)
    throw InputError("", "unknown asset " + sha256 + " (it may have been evicted; upload it to /v1/assets/" +
                             sha256 + ")");
  return *found;
}

MeshModelPtr AssetStore::model_asset(const std::string& sha256, const ModelState& state) const {
  return std::make_shared<const MeshModel>(read_model(find_for_scene(sha256)->bytes, {}, {}, state));
}

TexelsPtr AssetStore::picture_asset(const std::string& sha256) const {
  const AssetPtr asset = find_for_scene(sha256);
  const auto* const picture = std::get_if<Asset::Picture>(&asset->content);
  if (picture && picture->texels) return picture->texels;
  return std::make_shared<const Texels>(read_picture(asset->bytes));
}

}  // namespace orrery
