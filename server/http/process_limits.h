#pragma once

#include <cstddef>

namespace orrery {

inline constexpr std::size_t kHealthConnections = 16;  // of the health port

// Files and sockets that a server of so many connections may have open, with all others of the process.
std::size_t descriptors_for(std::size_t connections);

// Has the process allowed to open so many, if it can be. Returns how many it may.
std::size_t allow_descriptors(std::size_t count);

// Bytes of addresses that the process may use, however little memory is behind them; SIZE_MAX: no limit.
std::size_t allowed_addresses();
// What a server of so many connections takes at most, beside its memory, where so many threads render: stacks
// of all threads, and the program.
std::size_t addresses_for(std::size_t connections, std::size_t renderers);

}  // namespace orrery
