#include "core/shapes/rectangle.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Rectangle<N>::read(Params& p, std::vector<Rectangle<double>>& out) {
  constexpr double kMaxCosine = 1e-9;
  const Vec3d corner = p.point("corner", "A corner, in metres.");
  const Vec3d a = p.point("edge_u", "Vector from the corner along one side, in metres.");
  const Vec3d b = p.point(
      "edge_v",
      "Vector along the other side, perpendicular to edge_u, in metres; the front faces edge_u x edge_v.");
  const double length_a = length(a), length_b = length(b);
  if (!(length_a > 0)) p.fail("edge_u", "must be longer than 0 m");
  if (!(length_b > 0)) p.fail("edge_v", "must be longer than 0 m");
  if (!(length_a > 0 && length_b > 0)) return;
  const double cosine = dot(safe_normalize(a), safe_normalize(b));
  if (std::abs(cosine) > kMaxCosine)
    return p.fail("edge_v", "must be perpendicular to edge_u (got a cosine of " + number_text(cosine) + ")");
  const Vec3d normal = safe_normalize(cross(safe_normalize(a), safe_normalize(b)));
  out.push_back({corner, a, b, a / (length_a * length_a), b / (length_b * length_b), normal,
                 Boundsd::of({corner, corner + a, corner + b, corner + a + b}).magnitude()});
}

template <class N>
void Rectangle<N>::tessellate(const TessellationView&, int primitive, Tessellation& out) const {
  out.add_quad(primitive, out.add(corner, normal), out.add(corner + a, normal),
               out.add(corner + a + b, normal), out.add(corner + b, normal));
}

ShapeType rectangle_type() { return {"rectangle", "A flat rectangle.", make_shape_set<Rectangle>}; }

}  // namespace orrery
