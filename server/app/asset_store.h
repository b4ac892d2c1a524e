#pragma once

#include <memory>
#include <string>

#include "core/model/mesh_source.h"
#include "server/app/lru.h"

namespace orrery {

// Mesh files by the SHA-256 of their bytes. Safe from any thread.
class AssetStore final : public MeshSource {
 public:
  struct Asset {
    std::string bytes;
    MeshFormat format;
    std::size_t vertices, triangles;
  };
  using AssetPtr = std::shared_ptr<const Asset>;

  // Throws InputError if this can be no SHA-256.
  static void require_name(const std::string& name);

  explicit AssetStore(std::size_t most_bytes) : assets_(most_bytes) {}

  struct Added {
    AssetPtr asset;
    bool known;  // it was there before
  };
  // Throws InputError if the bytes have another hash, are no mesh, or take more than all assets may.
  Added add(const std::string& sha256, std::string bytes);
  // Throws NotFound.
  AssetPtr find(const std::string& sha256);
  void remove(const std::string& sha256);

  std::size_t bytes() const { return assets_.bytes(); }
  std::uint64_t evictions() const { return assets_.evictions(); }

  TriangleMesh asset(const std::string& sha256) const override;

 private:
  mutable Lru<AssetPtr> assets_;  // reading one counts as its use
};

}  // namespace orrery
