#pragma once

#include <string>
#include <utility>

#include "core/base/clock.h"
#include "core/base/task_scope.h"
#include "core/budget/renderer.h"
#include "core/render/views.h"

namespace orrery {

// PNG options for images that are shown only once, so that encoding time matters more than size.
inline constexpr PngOptions kFrameOfStream{.level = 1};

// Rendered and encoded image.
struct Frame {
  std::string bytes;
  RenderStats stats;
  Certificate certificate = {};
  double render_ms = 0, encode_ms = 0;
  MemoryCharge charge = {};  // memory charge of `bytes`, if any
};

// Encodes the film and measures the encoding time.
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
