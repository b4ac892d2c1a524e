#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/meshes/text.h"

namespace orrery {

enum class PlyEncoding { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// Returns the size of a binary value in bytes.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type;                            // type of the value, or of each list entry
  std::optional<PlyType> count_type = {};  // integer type of the list length; nullopt if not a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding;
  std::vector<PlyElement> elements;
  TextReader body;            // positioned at the first byte after the header
  std::size_t skipped_lines;  // lines before the first element that begin with no keyword
};

// Reads the header of a PLY file (Turk, The PLY Polygon File Format, 1994). Throws InputError with the line
// number if the header is invalid. Throws Cancelled. The views of the result point into `bytes`.
PlyHeader read_ply_header(std::string_view bytes);

}  // namespace orrery
