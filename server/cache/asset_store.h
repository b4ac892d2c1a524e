#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/model/asset_source.h"
#include "server/base/lru.h"

namespace orrery {

// Store of mesh and image files, keyed by the SHA-256 of their bytes. A file is held by the clients that
// uploaded it. Thread-safe.
class AssetStore final : public AssetSource {
 public:
  struct Asset {
    struct Mesh {
      MeshFormat format;
      std::size_t vertices, triangles;
      std::vector<std::string> notes;  // see notes_of()
    };
    struct Picture {
      PictureFormat format;
      int width, height;
      TexelsPtr texels;  // null if too large to store
    };
    std::string bytes;
    std::variant<Mesh, Picture> content;
  };
  using AssetPtr = std::shared_ptr<const Asset>;

  // Throws InputError unless `name` is a SHA-256 of 64 digits, 0-9 or a-f.
  static void require_name(const std::string& name);

  explicit AssetStore(std::size_t max_bytes) : assets_(max_bytes, std::chrono::hours(1)) {}

  struct AddResult {
    std::string id;  // SHA-256 of the bytes
    AssetPtr asset;
    bool known;  // it was already stored
  };
  // Stores a file for the client. Throws InputError if the bytes have another hash than `sha256`, unless it
  // is "", are neither mesh nor image, or exceed the limit of the store. Throws LimitExceeded if other
  // clients leave no room.
  AddResult add(const std::string& sha256, std::string bytes, const std::string& client);
  // Throws NotFound if the asset is not stored.
  AssetPtr find(const std::string& sha256);
  // Releases the asset for the client, or with `of_all` for all clients. Removes it once no client holds it.
  // Throws NotFound, or Forbidden if only other clients hold it.
  void remove(const std::string& sha256, const std::string& client, bool of_all);

  std::size_t bytes() const { return assets_.bytes(); }
  std::uint64_t evictions() const { return assets_.evictions(); }

  MeshModelPtr model_asset(const std::string& sha256, const ModelState& state) const override;
  TexelsPtr picture_asset(const std::string& sha256) const override;

 private:
  // Throws InputError if the asset is not stored.
  AssetPtr find_for_scene(const std::string& sha256) const;

  mutable Lru<AssetPtr> assets_;  // mutable: find() records a use
};

}  // namespace orrery
