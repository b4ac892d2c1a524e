#include "core/shapes/rectangle.h"

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Rectangle<N>::read(Params& p, std::vector<Rectangle<double>>& out) {
  constexpr double kMaxCosine = 1e-9;
  const Vec3d corner = p.point("corner", "One of its corners, in metres.");
  const Vec3d a = p.point("a", "From there along one side to the next corner, in metres.");
  const Vec3d b = p.point("b", "Along the other side; the front faces a x b.");
  const double length_a = length(a), length_b = length(b);
  if (!(length_a > 0)) p.fail("a", "expected a side of more than 0 m");
  if (!(length_b > 0)) p.fail("b", "expected a side of more than 0 m");
  if (!(length_a > 0 && length_b > 0)) return;
  const double cosine = dot(safe_normalize(a), safe_normalize(b));
  if (std::abs(cosine) > kMaxCosine)
    return p.fail("b", "expected a side at right angles to 'a', got a cosine of " + number_text(cosine));
  const Vec3d normal = safe_normalize(cross(safe_normalize(a), safe_normalize(b)));
  out.push_back({corner, a, b, a / (length_a * length_a), b / (length_b * length_b), normal,
                 Boundsd::of({corner, corner + a, corner + b, corner + a + b}).magnitude()});
}

ShapeType rectangle_type() {
  return {"rectangle", "A flat plate with four right angles.", make_shape_set<Rectangle>};
}

}  // namespace orrery
