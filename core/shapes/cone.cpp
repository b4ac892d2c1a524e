#include "core/shapes/cone.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Cone<N>::read(Params& p, std::vector<Cone<double>>& out) {
  const Vec3d base = p.point("base", "Centre of the base, in metres.");
  const Vec3d top = p.point("top", "Tip, or centre of the top cap, in metres.");
  const double base_radius = p.positive("base_radius", "Radius at the base, in metres.");
  const double top_radius =
      p.number("top_radius", "Radius at the top, in metres. 0 makes a tip.", {0, kMaxLength}, 0.0);
  if (base == top) p.fail("top", "must differ from base");
  const double height = length(top - base), growth = top_radius - base_radius;
  const double reach = std::max(max_component(abs(base)) + base_radius, max_component(abs(top)) + top_radius);
  out.push_back({(base + top) * 0.5, safe_normalize(top - base), (base_radius + top_radius) / 2, height / 2,
                 growth / height, height / std::hypot(height, growth), reach});
}

ShapeType cone_type() { return {"cone", "A cone or a frustum, with caps.", make_shape_set<Cone>}; }

}  // namespace orrery
