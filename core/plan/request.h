#pragma once

#include "core/model/plan.h"
#include "core/model/render_settings.h"

namespace orrery {

// Settings of one render. A setting without a value is taken from the scene.
struct RenderRequest : RenderSettings {
  bool full_model = false;   // plan every stage; the picture must not change
  int slice = Plan{}.slice;  // 16..kBatch

  bool operator==(const RenderRequest&) const = default;
};

}  // namespace orrery
