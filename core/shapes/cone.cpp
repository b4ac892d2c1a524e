#include "core/shapes/cone.h"

#include "core/model/tessellation.h"
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

// The quads of the wall are flat, because both polygons have the same number of sides.
template <class N>
void Cone<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  const Tangents<double> axes = tangents_of(axis);
  const Vec3d from_center = view.eye - center;
  const double along = dot(from_center, axis), from_axis = length(from_center - axis * along);
  const double largest = radius + std::abs(slope) * half_length;
  const double distance = std::max({std::abs(along) - half_length, from_axis - largest, 0.0});
  const int sectors = out.sides(view, largest, view.pixel_at(distance));
  const auto at = [&](double side, double scale, const SineCosine& turn) {
    const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
    return center + axis * (side * half_length) + across * (scale * (radius + side * slope * half_length));
  };
  out.add_rings(primitive, 2, sectors, [&](int ring, const SineCosine& turn) {
    const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
    return Tessellation::Vertex{at(ring == 0 ? 1 : -1, 1, turn), (across - axis * slope) * cosine};
  });
  for (const double side : {1.0, -1.0})
    if (radius + side * slope * half_length > 0)
      out.add_rings(primitive, 2, sectors, [&](int ring, const SineCosine& turn) {
        return Tessellation::Vertex{at(side, ring, {side * turn.sine, turn.cosine}), axis * side};
      });
}

ShapeType cone_type() { return {"cone", "A cone or a frustum, with caps.", make_shape_set<Cone>}; }

}  // namespace orrery
