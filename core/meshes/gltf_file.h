#pragma once

#include <vector>

#include "core/meshes/gltf_json.h"

namespace orrery {

// The numbers of an accessor: `count` vectors of `components` each. Lives no longer than its GltfFile.
struct GltfNumbers {
  const char* data;
  std::size_t count, stride;
  std::size_t components, component_bytes;
  double (*load)(const char*);  // as a double, normalized if the accessor says so

  double value(std::size_t i, std::size_t component) const {
    return load(data + i * stride + component * component_bytes);
  }
};

// A .glb or .gltf file and the buffers in it. Nothing outside the file is read: a buffer that lies elsewhere
// is refused. Throws InputError.
class GltfFile {
 public:
  explicit GltfFile(std::string_view bytes);

  GltfValue root() const { return {document_, ""}; }

  // Accessor `index`, which must be of `type` ("SCALAR", "VEC2", "VEC3") and is checked to lie in its buffer
  // to the last byte. `user` names it: where an index out of range is reported.
  GltfNumbers accessor(const GltfValue& user, std::string_view type);

 private:
  struct Buffer {
    bool decoded = false;
    std::vector<char> own;  // of a data: URI
    std::string_view bytes;
  };

  // Bytes of buffer view `index`.
  std::string_view view(const GltfValue& user);
  std::string_view buffer(const GltfValue& user);

  nlohmann::json document_;
  std::string_view binary_;  // chunk BIN of a .glb
  std::vector<Buffer> buffers_;
};

}  // namespace orrery
