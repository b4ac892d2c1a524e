#include "core/shapes/torus.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Torus<N>::read(Params& p, std::vector<Torus<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const Vec3d axis = p.direction("axis", "Direction of the axis of symmetry.");
  const double major = p.positive("major_radius", "Radius of the circle inside the tube, in metres.");
  const double minor =
      p.positive("minor_radius", "Radius of the tube, in metres. Must be less than major_radius.");
  if (minor >= major) p.fail("minor_radius", "must be less than major_radius");
  out.push_back({center, axis, major, minor, max_component(abs(center)) + major + minor});
}

// A flat triangle in a patch of du by dv radians is within (|P_uu| du^2 + 2 |P_uv| du dv + |P_vv| dv^2) / 8
// of the surface P (Filip, Magedson and Markot, "Surface algorithms using bounds on derivatives", 1986).
// Here, the derivatives are at most major + minor, minor and minor, and 2 du dv <= du^2 + dv^2.
template <class N>
void Torus<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  const Tangents<double> axes = tangents_of(axis);
  const Vec3d eye = view.eye - center;
  const double height = dot(eye, axis), from_axis = length(eye - axis * height);
  const double pixel = view.pixel_at(std::abs(std::hypot(from_axis - major, height) - minor));
  const int sectors = out.sides(view, major + 2 * minor, pixel, 0.5);
  const int rings = out.sides(view, 2 * minor, pixel, 0.5);
  out.add_rings(primitive, rings + 1, sectors, [&](int ring, const SineCosine& turn) {
    const SineCosine tube = sine_cosine_degrees(-360.0 * ring / rings);
    const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
    const Vec3d normal = across * tube.cosine + axis * tube.sine;
    return Tessellation::Vertex{center + across * major + normal * minor, normal};
  });
}

ShapeType torus_type() { return {"torus", "A ring with a round tube.", make_shape_set<Torus>}; }

}  // namespace orrery
