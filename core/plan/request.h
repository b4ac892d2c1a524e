#pragma once

#include "core/model/plan.h"
#include "core/model/render_settings.h"

namespace orrery {

// Settings of one render. resolve() takes missing settings from the scene or from the defaults.
struct RenderRequest : RenderSettings {
  bool full_model = false;   // keep stages that the scene does not need; the image is the same
  int slice = Plan{}.slice;  // rays per slice, 16 to kBatch; see Plan::slice

  bool operator==(const RenderRequest&) const = default;
};

}  // namespace orrery
