#pragma once

#include "core/model/plan.h"
#include "core/model/render_settings.h"

namespace orrery {

// What one render asks beside what its scene says. Settings without a value are left to the scene.
struct RenderRequest : RenderSettings {
  bool full_model = false;   // every stage present, whatever the scene: the planned picture must equal it
  int slice = Plan{}.slice;  // 16..kBatch

  bool operator==(const RenderRequest&) const = default;
};

}  // namespace orrery
