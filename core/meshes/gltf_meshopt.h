#pragma once

#include "core/meshes/gltf_json.h"

namespace orrery {

// Compressed content of a buffer view (EXT_meshopt_compression). Must not outlive the document.
class MeshoptView {
 public:
  // Reads the members of the extension. Throws InputError if one is invalid, or if the content does not fill
  // the buffer view `view`.
  MeshoptView(const GltfValue& view, const GltfValue& extension);

  // Returns the decoded size in bytes.
  std::uint64_t decoded_bytes() const { return count_ * stride_; }

  // Decodes the compressed bytes. Throws InputError if they are damaged, or if they are too few for the
  // decoded size. This is checked before memory is allocated.
  std::string decode(std::string_view bytes) const;

 private:
  enum class Mode { attributes, triangles, indices };
  enum class Filter { none, octahedral, quaternion, exponential };

  static Mode mode_of(const GltfValue& extension);
  static Filter filter_of(const GltfValue& extension);
  void check_stride(const GltfValue& extension) const;
  int run_decoder(std::string& decoded, std::string_view bytes) const;
  void apply_filter(std::string& decoded) const;

  GltfValue place_;
  std::uint64_t stride_, count_;
  Mode mode_;
  Filter filter_;
};

}  // namespace orrery
