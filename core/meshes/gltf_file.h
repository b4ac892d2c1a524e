#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/meshes/gltf_json.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

// Numbers of an accessor: `count` elements of `components` numbers. `stride` and `component_bytes` are in
// bytes. Must not outlive its GltfFile.
struct GltfNumbers {
  const char* data;
  std::size_t count, stride;
  std::size_t components, component_bytes;
  double (*load)(const char*);  // loads one number, and normalizes it if the accessor is normalized

  double value(std::size_t i, std::size_t component) const {
    return load(data + i * stride + component * component_bytes);
  }
};

// A .glb or .gltf file with its buffers. Throws InputError and Cancelled. Not thread-safe, because accessor()
// decodes and caches buffers.
class GltfFile {
 public:
  // `nearby` reads buffers in other files; if it is empty, they are an error.
  GltfFile(std::string_view bytes, const ReadNearby& nearby);

  GltfValue root() const { return {document_, ""}; }

  // Returns the numbers of the accessor whose index is the value `user`, with the replacements of a sparse
  // accessor. Throws InputError if there is no such accessor, an element is outside the buffer view, or the
  // type is not `type` ("SCALAR", "VEC2", "VEC3", "VEC4" or "MAT4").
  GltfNumbers accessor(const GltfValue& user, std::string_view type);
  // Returns the numbers of an accessor that must have `count` elements, one per position.
  GltfNumbers attribute(const GltfValue& user, std::string_view type, std::size_t count);

  // Decodes the vertices and indices of a primitive that uses KHR_draco_mesh_compression. From then on,
  // accessor() returns them for the accessors of the primitive. Does nothing for other primitives. Throws
  // InputError if the mesh is damaged or too large, or its sizes differ from those of the accessors.
  void decode_primitive(const GltfValue& primitive, const MeshLimits& limits);

  // Returns the bytes of an image. Throws InputError if they cannot be read.
  std::string_view image_bytes(const GltfValue& image);

 private:
  struct Buffer {
    bool decoded = false;
    std::string_view bytes;
  };

  // view() and buffer() return the bytes of the buffer view or buffer whose index is the value `user`.
  std::string_view view(const GltfValue& user);
  std::string_view buffer(const GltfValue& user);
  // Returns `byteLength` bytes of a buffer at `byteOffset`, as the members of `range` state.
  std::string_view bytes_in(const GltfValue& range);
  // Returns the content of a compressed buffer view.
  std::string_view expanded(std::uint64_t index, const GltfValue& view, const GltfValue& extension);

  // Returns the bytes of a data: URI, or of the file that the URI names.
  std::string_view bytes_of(const GltfValue& uri);
  // Returns the elements of the buffer view that `place` names, at its byteOffset.
  GltfNumbers elements(const GltfValue& place, std::uint64_t count, std::string_view type,
                       const GltfValue& component_type, bool normalized);
  // Sets the numbers of an accessor, integers that are not normalized.
  void set_accessor(const GltfValue& user, std::vector<double> values);
  // Returns the numbers of a sparse accessor, or of one without a buffer view.
  GltfNumbers unpacked(const GltfValue& accessor, std::uint64_t count, std::string_view type,
                       bool normalized);

  const ReadNearby& nearby_;
  std::deque<std::string> decoded_;           // contents of data: URIs
  std::map<std::string, std::string> files_;  // contents of other files, by name
  std::size_t file_bytes_ = 0;
  std::map<std::uint64_t, std::string> expanded_;  // contents of compressed buffer views
  std::uint64_t expanded_bytes_ = 0;
  std::deque<std::vector<double>> unpacked_;                 // numbers of accessors that are not in a buffer
  std::uint64_t unpacked_values_ = 0;                        // without those of Draco meshes
  std::map<std::uint64_t, GltfNumbers> known_;               // the same, by accessor
  std::set<std::vector<std::uint64_t>> decoded_primitives_;  // buffer views and accessors of primitives
  nlohmann::json document_;
  std::string_view binary_;  // BIN chunk of a .glb file
  std::vector<Buffer> buffers_;
};

}  // namespace orrery
