#pragma once

#include "core/model/plan.h"
#include "core/model/render_settings.h"

namespace orrery {

// Settings of one render. resolve() replaces missing settings by those of the scene or by defaults.
struct RenderRequest : RenderSettings {
  bool full_model = false;   // keep stages that the scene does not need; same image
  int slice = Plan{}.slice;  // rays per slice, 16 to kBatch; see Plan::slice

  bool operator==(const RenderRequest&) const = default;
};

}  // namespace orrery
