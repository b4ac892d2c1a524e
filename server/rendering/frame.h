#pragma once

#include <string>

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

}  // namespace orrery
