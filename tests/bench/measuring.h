#pragma once

#include <time.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>

#include "core/load/asset_files.h"
#include "core/load/load.h"

// Shared helpers of the benchmark programs.
namespace orrery::bench {

// Returns the processor seconds of the calling thread.
inline double thread_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return double(used.tv_sec) + double(used.tv_nsec) * 1e-9;
}

inline std::shared_ptr<const Scene> load_scene_at(const std::string& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return load_scene(text, AssetFiles(std::filesystem::path(path).parent_path()));
}

// Reads lines "ours" or "theirs" from standard input. For each line, prints the sum of `repeats` calls of
// seconds_of(is_ours).
template <class SecondsOf>
void serve_runs(int repeats, const SecondsOf& seconds_of) {
  for (std::string side; std::getline(std::cin, side);) {
    double seconds = 0;
    for (int i = 0; i < repeats; ++i) seconds += seconds_of(side == "ours");
    std::printf("%.9f\n", seconds);
    std::fflush(stdout);
  }
}

}  // namespace orrery::bench
