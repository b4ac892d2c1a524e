#pragma once

#include <memory>
#include <string>
#include <variant>

#include "core/model/asset_source.h"
#include "server/app/lru.h"

namespace orrery {

// Mesh and picture files by the SHA-256 of their bytes, held by the clients that have put them. Safe from any
// thread.
class AssetStore final : public AssetSource {
 public:
  struct Asset {
    struct Mesh {
      MeshFormat format;
      std::size_t vertices, triangles;
    };
    struct Picture {
      PictureFormat format;
      int width, height;
      TexelsPtr texels;  // null if they take more of the store than one picture may
    };
    std::string bytes;
    std::variant<Mesh, Picture> content;
  };
  using AssetPtr = std::shared_ptr<const Asset>;

  // Throws InputError if this can be no SHA-256.
  static void require_name(const std::string& name);

  explicit AssetStore(std::size_t most_bytes) : assets_(most_bytes, std::chrono::hours(1)) {}

  struct Added {
    AssetPtr asset;
    bool known;  // it was there before
  };
  // Throws InputError if the bytes have another hash, are neither mesh nor picture, or take more than all
  // assets may; OverLimit if others leave no room for them.
  Added add(const std::string& sha256, std::string bytes, const std::string& client);
  // Throws NotFound.
  AssetPtr find(const std::string& sha256);
  // The client holds the asset no more: it goes unless others do, or with `of_all` in any case. Throws
  // NotFound, and HttpError 403 if others alone hold it.
  void remove(const std::string& sha256, const std::string& client, bool of_all);

  std::size_t bytes() const { return assets_.bytes(); }
  std::uint64_t evictions() const { return assets_.evictions(); }

  TriangleMesh mesh_asset(const std::string& sha256) const override;
  TexelsPtr picture_asset(const std::string& sha256) const override;

 private:
  // Throws InputError if there is none.
  AssetPtr find_for_scene(const std::string& sha256) const;

  mutable Lru<AssetPtr> assets_;  // reading one counts as its use
};

}  // namespace orrery
