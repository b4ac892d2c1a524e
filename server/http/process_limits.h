#pragma once

#include <cstddef>

namespace orrery {

inline constexpr std::size_t kHealthConnections = 16;  // limit of the health port

// Returns the maximum number of file descriptors of a server with `connections` connections, including other
// files.
std::size_t descriptors_for(std::size_t connections);

// Raises the descriptor limit of the process to `count` if possible. Returns the resulting limit.
std::size_t allow_descriptors(std::size_t count);

// Returns the address space limit of the process in bytes, or SIZE_MAX if it is unlimited.
std::size_t allowed_addresses();
// Returns the maximum address space in bytes of a server with `connections` connections and `renderers`
// render threads. Includes stacks and program, but not the memory counted by memory_bytes.
std::size_t addresses_for(std::size_t connections, std::size_t renderers);

}  // namespace orrery
