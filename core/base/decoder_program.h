#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

// Limits, input and output of a program that DecoderProcess starts.
namespace orrery {

// Writes to standard output. Ends the process if the reader has closed the pipe.
inline void write_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written <= 0) std::_Exit(1);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

// Returns the writable memory that this process has mapped, in bytes, as RLIMIT_DATA counts it.
[[maybe_unused]] inline rlim_t mapped_data() {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  unsigned long pages = 0;
  const bool read = file && std::fscanf(file, "%*u %*u %*u %*u %*u %lu", &pages) == 1;
  if (file) std::fclose(file);
  return read ? pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) : 0;
}

// Limits the CPU time, in seconds. Ends the process if its parent ends, and closes all files but the standard
// ones.
inline void limit_process(rlim_t max_seconds) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  close_range(STDERR_FILENO + 1, ~0U, 0);
  const rlimit seconds{max_seconds, max_seconds}, none{0, 0};
  setrlimit(RLIMIT_CPU, &seconds);
  setrlimit(RLIMIT_CORE, &none);
}

// Allows `bytes` in addition to the memory that is already mapped.
inline void limit_memory([[maybe_unused]] std::uint64_t bytes) {
#ifndef ORRERY_SANITIZED  // the sanitizer's own memory counts as data
  const rlim_t most = mapped_data() + bytes;
  const rlimit data{most, most};
  setrlimit(RLIMIT_DATA, &data);
#endif
}

// Maps standard input, which must be a file, to memory. Returns an empty range on failure.
inline std::span<std::byte> map_input() {
  struct stat status {};
  if (fstat(STDIN_FILENO, &status) != 0 || status.st_size <= 0) return {};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const start = mmap(nullptr, size, PROT_READ, MAP_SHARED, STDIN_FILENO, 0);
  if (start == MAP_FAILED) return {};
  return {static_cast<std::byte*>(start), size};
}

}  // namespace orrery
