#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "server/rendering/frame.h"
#include "server/scheduler/work_account.h"
#include "server/scheduler/worker_pool.h"

namespace orrery {

// Renders a sequence of frames while earlier frames are encoded. `next` and `render` run on the caller's
// thread and may block. `encode` and `deliver` run on pool threads and must not block. The pool is therefore
// busy from the first frame to the last, without further compute threads.
struct Pipeline {
  WorkerPool& pool;
  bool background;                                    // yields to other work
  std::function<std::optional<std::int64_t>()> next;  // number of the frame to render, or nullopt at the end
  std::function<RenderResult(std::int64_t)> render;
  std::function<std::string(const Film&)> encode;      // called by several threads at once
  std::stop_token stop = {};                           // cancels encoding, which throws Cancelled
  WorkAccount* memory = nullptr;                       // opens the account of encoded frames; may be null
  std::function<void(std::int64_t, Frame&&)> deliver;  // called one at a time, in the order of `next`

  // Returns once all frames are delivered. If a stage throws, delivers the earlier frames and rethrows.
  void run() const;
};

}  // namespace orrery
