#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "server/app/frame.h"

namespace orrery {

// A row of frames in which one is rendered while the one before it is encoded and handed on. `next` and
// `render` are called on the caller's thread, `encode` and `deliver` on one of the pipeline's; each may wait.
// At most three frames are under way: one in each stage and one between them.
struct Pipeline {
  std::function<std::optional<std::int64_t>()> next;  // number of the frame to render; none: the end
  std::function<RenderResult(std::int64_t)> render;
  std::function<std::string(const Image&)> encode;
  std::function<bool(std::int64_t, Frame&&)> deliver;  // in the order of `next`; false: no more

  // Returns once all frames are delivered or one was refused. What a stage throws ends it and is thrown here,
  // after the frames rendered before have been delivered.
  void run() const;
};

}  // namespace orrery
