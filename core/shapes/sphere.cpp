#include "core/shapes/sphere.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Sphere<N>::read(Params& p, std::vector<Sphere<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const double radius = p.positive("radius", "Radius, in metres.");
  out.push_back({{center, radius}, max_component(abs(center)) + radius});
}

// The corners of a quad are at most sqrt(2) times as far apart as two neighbours on the equator. A quad is
// therefore as far from the sphere as the sides of a polygon with sqrt(2) times fewer sides.
template <class N>
void Sphere<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  const double distance = std::abs(length(view.eye - ball.center) - ball.radius);
  const int sectors = out.sides(view, 2 * ball.radius, view.pixel_at(distance)), half = (sectors + 1) / 2;
  std::vector<SineCosine> latitudes;
  for (int ring = 0; ring <= half; ++ring) latitudes.push_back(sine_cosine_degrees(180.0 * ring / half));
  out.add_rings(primitive, half + 1, sectors, [&](int ring, const SineCosine& turn) {
    const SineCosine& latitude = latitudes[static_cast<std::size_t>(ring)];
    const Vec3d normal(latitude.sine * turn.sine, latitude.cosine, latitude.sine * turn.cosine);
    return Tessellation::Vertex{ball.center + normal * ball.radius, normal};
  });
}

ShapeType sphere_type() { return {"sphere", "A sphere.", make_shape_set<Sphere>}; }

}  // namespace orrery
