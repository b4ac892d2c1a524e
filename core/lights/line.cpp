#include "core/lights/line.h"

#include "core/lights/light_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Line<double> Line<N>::read(Params& p) {
  const Vec3d from = p.point("from", "Where the line begins, in metres.");
  const Vec3d to = p.point("to", "Where it ends, in metres.");
  const Vec3d intensity =
      p.color("intensity_per_metre", "What a metre sends in every direction, in W/sr.", Vec3d(1));
  const Vec3d along = safe_normalize(to - from);
  if (along == Vec3d()) p.fail("to", "expected a point other than from");
  return {from, along, length(to - from), intensity};
}

LightType line_type() { return {"line", "Light from a line, which is not seen.", make_light_set<Line>}; }

}  // namespace orrery
