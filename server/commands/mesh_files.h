#pragma once

#include <filesystem>

#include "core/model/mesh_source.h"

namespace orrery {

// Mesh files in the folder of a scene or below it.
class MeshFiles final : public MeshSource {
 public:
  explicit MeshFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  TriangleMesh file(const std::string& name) const override;

 private:
  std::filesystem::path folder_;
};

}  // namespace orrery
