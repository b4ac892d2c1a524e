#pragma once

#include <cstdint>

namespace orrery {

// Protocol between decode_draco() and the program orrery-decode-mesh. The command line is
//  orrery-decode-mesh BYTES POINTS FACES ATTRIBUTE:COMPONENTS...
// BYTES is the memory that the program may allocate. The mesh must have POINTS points and FACES triangles.
// Each ATTRIBUTE is the unique id of an attribute that is returned, and COMPONENTS is its number of
// components. Standard input is a Draco mesh. The program writes a DecodedMeshHeader to standard output.
// After it follow `text_bytes` of an error message, or 3 x FACES indices and POINTS x COMPONENTS numbers for
// each attribute. Indices and numbers have the type double.
struct DecodedMeshHeader {
  std::uint64_t text_bytes;  // 0 if the mesh was decoded
};

}  // namespace orrery
