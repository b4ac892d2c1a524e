#include "core/meshes/gltf_meshopt.h"

#include <meshoptimizer.h>

#include "core/base/shorten.h"
#include "core/meshes/text.h"

// EXT_meshopt_compression (Khronos, ratified 2021). The KHR variant of 2025 adds an encoding and a filter
// that libmeshoptimizer 0.18 cannot decode.
namespace orrery {
namespace {

// Maximum ratio of decoded to compressed bytes. Each group of 16 bytes takes at least 2 bits in mode
// ATTRIBUTES. Three indices of 4 bytes take at least 1 byte in mode TRIANGLES, and one takes 1 byte in mode
// INDICES.
constexpr std::uint64_t kMaxRatio = 64;

}  // namespace

MeshoptView::MeshoptView(const GltfValue& view, const GltfValue& extension)
    : place_(extension),
      stride_(extension.at("byteStride").integer()),
      count_(extension.at("count").integer()),
      mode_(mode_of(extension)),
      filter_(filter_of(extension)) {
  check_stride(extension);
  const std::uint64_t length = view.at("byteLength").integer();
  if (length % stride_ != 0 || length / stride_ != count_)
    extension.fail("count * byteStride must be " + std::to_string(length) +
                   ", the byteLength of the buffer view (got " + std::to_string(count_) + " * " +
                   std::to_string(stride_) + ")");
  if (mode_ == Mode::triangles && count_ % 3 != 0)
    extension.fail("count must be a multiple of 3 in mode TRIANGLES (got " + std::to_string(count_) + ")");
}

MeshoptView::Mode MeshoptView::mode_of(const GltfValue& extension) {
  const GltfValue mode = extension.at("mode");
  if (mode.text() == "ATTRIBUTES") return Mode::attributes;
  if (mode.text() == "TRIANGLES") return Mode::triangles;
  if (mode.text() == "INDICES") return Mode::indices;
  mode.fail("must be ATTRIBUTES, TRIANGLES or INDICES (got " + excerpt(mode.text()) + ")");
}

MeshoptView::Filter MeshoptView::filter_of(const GltfValue& extension) {
  const auto filter = extension.find("filter");
  if (!filter || filter->text() == "NONE") return Filter::none;
  if (filter->text() == "OCTAHEDRAL") return Filter::octahedral;
  if (filter->text() == "QUATERNION") return Filter::quaternion;
  if (filter->text() == "EXPONENTIAL") return Filter::exponential;
  filter->fail("must be NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL (got " + excerpt(filter->text()) + ")");
}

void MeshoptView::check_stride(const GltfValue& extension) const {
  const auto require = [&](bool holds, const char* allowed) {
    if (!holds)
      extension.fail("byteStride must be " + std::string(allowed) + " (got " + std::to_string(stride_) + ")");
  };
  if (mode_ == Mode::attributes) {
    require(stride_ >= 4 && stride_ <= 256 && stride_ % 4 == 0, "a multiple of 4 from 4 to 256");
  } else {
    require(stride_ == 2 || stride_ == 4, "2 or 4 for indices");
    if (filter_ != Filter::none) extension.at("filter").fail("must be NONE for indices");
  }
  if (filter_ == Filter::octahedral) require(stride_ == 4 || stride_ == 8, "4 or 8 with filter OCTAHEDRAL");
  if (filter_ == Filter::quaternion) require(stride_ == 8, "8 with filter QUATERNION");
}

std::string MeshoptView::decode(std::string_view bytes) const {
  if (decoded_bytes() / kMaxRatio > bytes.size())
    place_.fail("byteLength must be at least " + std::to_string(decoded_bytes() / kMaxRatio) + " for " +
                grouped(decoded_bytes()) + " decoded bytes (got " + std::to_string(bytes.size()) + ")");
  std::string decoded(decoded_bytes(), '\0');
  if (const int code = run_decoder(decoded, bytes); code != 0)
    place_.fail("must be " + std::to_string(count_) + " compressed elements of " + std::to_string(stride_) +
                " bytes (got " + std::to_string(bytes.size()) + " damaged bytes, code " +
                std::to_string(code) + ")");
  apply_filter(decoded);
  return decoded;
}

int MeshoptView::run_decoder(std::string& decoded, std::string_view bytes) const {
  const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
  switch (mode_) {
    case Mode::attributes:
      return meshopt_decodeVertexBuffer(decoded.data(), count_, stride_, from, bytes.size());
    case Mode::triangles:
      return meshopt_decodeIndexBuffer(decoded.data(), count_, stride_, from, bytes.size());
    case Mode::indices:
      return meshopt_decodeIndexSequence(decoded.data(), count_, stride_, from, bytes.size());
  }
  return -1;
}

void MeshoptView::apply_filter(std::string& decoded) const {
  switch (filter_) {
    case Filter::none: return;
    case Filter::octahedral: return meshopt_decodeFilterOct(decoded.data(), count_, stride_);
    case Filter::quaternion: return meshopt_decodeFilterQuat(decoded.data(), count_, stride_);
    case Filter::exponential: return meshopt_decodeFilterExp(decoded.data(), count_, stride_);
  }
}

}  // namespace orrery
