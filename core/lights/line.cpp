#include "core/lights/line.h"

#include "core/lights/light_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Line<double> Line<N>::read(Params& p) {
  const Vec3d from = p.point("from", "One end of the line, in metres.");
  const Vec3d to = p.point("to", "The other end, in metres.");
  const Vec3d intensity =
      p.color("intensity_per_metre", "Radiant intensity per metre of the line, in W/(sr m).", Vec3d(1));
  const Vec3d along = safe_normalize(to - from);
  if (along == Vec3d()) p.fail("to", "must differ from \"from\"");
  return {from, along, length(to - from), intensity};
}

LightType line_type() { return {"line", "An invisible line light.", make_light_set<Line>}; }

}  // namespace orrery
