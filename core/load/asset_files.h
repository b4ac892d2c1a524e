#pragma once

#include <filesystem>

#include "core/model/asset_source.h"

namespace orrery {

// Mesh and image files in the folder of a scene or below it.
class AssetFiles final : public AssetSource {
 public:
  explicit AssetFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  TriangleMesh mesh_file(const std::string& name) const override;
  TexelsPtr picture_file(const std::string& name) const override;

 private:
  // Returns read(bytes) for the file. Throws InputError with the file's name.
  template <class Read>
  auto read_with(const std::string& name, const Read& read) const;

  std::filesystem::path folder_;
};

}  // namespace orrery
