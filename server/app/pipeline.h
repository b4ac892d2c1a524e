#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "server/app/frame.h"

namespace orrery {

// A row of frames in which one is rendered while those before it are encoded. `next` and `render` are called
// on the caller's thread, each may wait. `encode` and `deliver` are called on the pool's, which so have work
// from the first frame to the last and no others to share the cores with; they must not wait.
struct Pipeline {
  WorkerPool& pool;
  bool background;                                    // others come first
  std::function<std::optional<std::int64_t>()> next;  // number of the frame to render; none: the end
  std::function<RenderResult(std::int64_t)> render;
  std::function<std::string(const Film&)> encode;  // several at once
  std::stop_token stop = {};                       // ends what is being encoded, with Cancelled
  MemoryAccount* memory = nullptr;  // encoded frames are charged to another like it; none: nullptr
  std::function<void(std::int64_t, Frame&&)> deliver;  // one at a time, in the order of `next`

  // Returns once all frames are delivered. What a stage throws ends it and is thrown here, after the frames
  // before have been delivered.
  void run() const;
};

}  // namespace orrery
