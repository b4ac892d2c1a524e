#pragma once

#include <filesystem>

#include "core/model/asset_source.h"

namespace orrery {

// Meshes and pictures in files in the folder of a scene or below it.
class AssetFiles final : public AssetSource {
 public:
  explicit AssetFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  TriangleMesh mesh_file(const std::string& name) const override;
  TexelsPtr picture_file(const std::string& name) const override;

 private:
  // What read(bytes) makes of the file. Throws InputError with its name.
  template <class Read>
  auto read_with(const std::string& name, const Read& read) const;

  std::filesystem::path folder_;
};

}  // namespace orrery
