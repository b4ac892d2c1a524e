#include "core/plan/eye_media.h"

#include <algorithm>

namespace orrery {

bool may_start_in(const Media& media, const Plan& plan) {
  const Vec3d lens(plan.frame.aperture_radius);
  return plan.camera->parallel() ||
         std::any_of(media.bounds.begin(), media.bounds.end(), [&](const Boundsd& box) {
           Boundsd around = box;
           around.lo = box.lo - lens;
           around.hi = box.hi + lens;
           return around.contains(plan.frame.eye);
         });
}

}  // namespace orrery
