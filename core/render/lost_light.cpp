#include "core/render/lost_light.h"

#include "core/plan/warnings.h"

namespace orrery {

void name_lost_light(const Scene& scene, const Plan& plan, Certificate& certificate) {
  if (loses_caustics(scene, plan)) certificate.not_followed.push_back("caustics of lights without extent");
}

}  // namespace orrery
