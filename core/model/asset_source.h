#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/image/decode/picture.h"
#include "core/meshes/model.h"

namespace orrery {

class ImageLevels;  // core/textures/image_map.h
using ImageLevelsPtr = std::shared_ptr<const ImageLevels>;

// Source of meshes and images that a scene refers to by name. The base class rejects every name. Derived
// classes read files or look up uploaded assets. Each function throws InputError (pointer "") if the asset is
// missing or invalid, and may throw Cancelled. Called only by the thread that loads the scene.
class AssetSource {
 public:
  virtual ~AssetSource() = default;

  // Returns the contents of a file in or below the folder of the scene file. `state`: see read_model().
  virtual MeshModelPtr model_file(const std::string& /*name*/, const ModelState& /*state*/ = {}) const {
    refuse_files();
  }
  virtual TexelsPtr picture_file(const std::string& /*name*/) const { refuse_files(); }
  // Returns an uploaded asset by the SHA-256 of its bytes, in hexadecimal.
  virtual MeshModelPtr model_asset(const std::string& /*sha256*/, const ModelState& /*state*/ = {}) const {
    refuse_assets();
  }
  virtual TexelsPtr picture_asset(const std::string& /*sha256*/) const { refuse_assets(); }
  // Returns make(), which computes the levels of an image from this source. `key` identifies the image and
  // its encoding: sources may keep levels by key. Passes the errors of `make`.
  virtual ImageLevelsPtr levels(const std::string& /*key*/,
                                const std::function<ImageLevelsPtr()>& make) const {
    return make();
  }

 private:
  [[noreturn]] static void refuse_files() {
    throw InputError("",
                     "files can be read only on the command line; upload the file and use \"asset\" instead");
  }
  [[noreturn]] static void refuse_assets() {
    throw InputError("", "assets exist only on a server; use \"file\" instead");
  }
};

// One model, by the states in which it was read.
using ModelStates = std::map<ModelState, MeshModelPtr>;

// Source of one model for any name. For states that were not read, it returns the model in the first one.
class OneModel final : public AssetSource {
 public:
  // REQUIRES: there is a state.
  explicit OneModel(ModelStates states) : states_(std::move(states)) {}
  explicit OneModel(MeshModelPtr model) : states_{{{}, std::move(model)}} {}
  MeshModelPtr model_file(const std::string&, const ModelState& state) const override { return in(state); }
  MeshModelPtr model_asset(const std::string&, const ModelState& state) const override { return in(state); }

 private:
  const MeshModelPtr& in(const ModelState& state) const {
    const auto found = states_.find(state);
    return found == states_.end() ? states_.begin()->second : found->second;
  }

  ModelStates states_;
};

// Source of the meshes of a scene, with running totals, because limits apply to all meshes of a scene
// together.
struct MeshSource {
  const AssetSource& assets;
  std::size_t vertices = 0, triangles = 0;  // including those of animation keys
  bool full = false;                        // a limit was exceeded; further meshes are skipped
  std::uint64_t pairs = 0;                  // pairs of corners compared by smoothing: see count_pairs()
};

}  // namespace orrery
