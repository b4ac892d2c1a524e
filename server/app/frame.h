#pragma once

#include <string>
#include <utility>

#include "core/base/clock.h"
#include "core/base/work_scope.h"
#include "core/render/renderer.h"
#include "core/render/views.h"

namespace orrery {

// For pictures that are shown once and thrown away: the time to encode counts more than the bytes.
inline constexpr PngOptions kFrameOfStream{.level = 1};

// A rendered and encoded picture.
struct Frame {
  std::string bytes;
  RenderStats stats;
  Certificate certificate = {};
  double render_ms = 0, encode_ms = 0;
  MemoryCharge charge = {};  // for the bytes, where they are counted
};

// Adds what `encoder` makes of the film, and how long that took.
template <class Encoder>
Frame encode_frame(RenderResult&& rendered, double render_ms, const Encoder& encoder) {
  const auto start = Clock::now();
  Frame frame{.bytes = encoder(rendered.film),
              .stats = rendered.stats,
              .certificate = std::move(rendered.certificate),
              .render_ms = render_ms};
  frame.encode_ms = milliseconds_since(start);
  return frame;
}

}  // namespace orrery
