#pragma once

#include <cstddef>

namespace orrery {

// Files and sockets that a server of so many connections may have open, with all others of the process.
std::size_t descriptors_for(std::size_t connections);

// Has the process allowed to open so many, if it can be. Returns how many it may.
std::size_t allow_descriptors(std::size_t count);

}  // namespace orrery
