#pragma once

#include <filesystem>

#include "core/model/asset_source.h"

namespace orrery {

// Returns a function that reads files in the folder of a mesh file, or below it.
ReadNearby files_near(const std::filesystem::path& file);

// Model file on the command line.
struct ModelFile {
  std::size_t bytes;
  MeshModelPtr model;
};
// Reads a model file in a state (see read_model()) with the files in its folder that it names, or standard
// input if `path` is "-". Throws FileError, and BadScene if the file is invalid.
ModelFile read_model_file(const std::string& path, const ModelState& state = {});

// Mesh and image files in the folder of a scene or below it.
class AssetFiles final : public AssetSource {
 public:
  explicit AssetFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  MeshModelPtr model_file(const std::string& name, const ModelState& state) const override;
  TexelsPtr picture_file(const std::string& name) const override;

 private:
  // Returns read(bytes, path) for the file. Throws InputError with the file's name.
  template <class Read>
  auto read_with(const std::string& name, const Read& read) const;

  std::filesystem::path folder_;
};

}  // namespace orrery
