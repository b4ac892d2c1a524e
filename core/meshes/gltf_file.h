#pragma once

#include <vector>

#include "core/meshes/gltf_json.h"

namespace orrery {

// Numbers of an accessor: `count` vectors of `components` each. Must not outlive its GltfFile.
struct GltfNumbers {
  const char* data;
  std::size_t count, stride;
  std::size_t components, component_bytes;
  double (*load)(const char*);  // loads a double, normalized if the accessor is

  double value(std::size_t i, std::size_t component) const {
    return load(data + i * stride + component * component_bytes);
  }
};

// A .glb or .gltf file with its buffers. Never reads other files; external buffers are rejected. Throws
// InputError and Cancelled. Not thread-safe: accessor() decodes buffers.
class GltfFile {
 public:
  explicit GltfFile(std::string_view bytes);

  GltfValue root() const { return {document_, ""}; }

  // Returns the accessor with index `user`, after checking that all its elements lie in the buffer. Throws
  // InputError if it is not of `type` ("SCALAR", "VEC2", "VEC3"). Errors in the index are reported at `user`.
  GltfNumbers accessor(const GltfValue& user, std::string_view type);

 private:
  struct Buffer {
    bool decoded = false;
    std::vector<char> own;  // decoded data: URI
    std::string_view bytes;
  };

  // Returns the bytes of the buffer view with index `user`.
  std::string_view view(const GltfValue& user);
  std::string_view buffer(const GltfValue& user);

  nlohmann::json document_;
  std::string_view binary_;  // chunk BIN of a .glb
  std::vector<Buffer> buffers_;
};

}  // namespace orrery
