#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace orrery {

struct DracoAttribute {
  std::uint64_t id;  // unique id in the Draco mesh
  std::size_t components;
};

struct DracoMesh {
  std::vector<double> indices;  // 3 per face, each < points
  // By attribute: numbers of each point. Integers are not normalized.
  std::vector<std::vector<double>> attributes;
};

// Decodes a Draco mesh (bitstream 2.2) in a separate process, orrery-decode-mesh. The memory of the process
// is limited by the numbers of points and faces, and is charged to the account of the calling thread.
// REQUIRES: attributes have 1 to 4 components.
//
// Throws InputError (pointer "") if the mesh is damaged, or has other numbers of points, faces or components.
// Throws Cancelled within 20 ms after cancellation, std::bad_alloc, and std::system_error if the operating
// system refuses a process.
DracoMesh decode_draco(std::string_view bytes, std::size_t points, std::size_t faces,
                       std::span<const DracoAttribute> attributes);

}  // namespace orrery
