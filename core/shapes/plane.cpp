#include "core/shapes/plane.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Plane<N>::read(Params& p, std::vector<Plane<double>>& out) {
  const Vec3d point = p.point("point", "Any point on the plane, in metres.");
  const Vec3d normal = p.direction("normal", "Normal of the front side.");
  out.push_back({point, normal});
}

// A disk that grows in rings about the point nearest to the eye, so that vertices are dense near the eye. For
// parallel cameras, the disk covers the view.
template <class N>
void Plane<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  constexpr int kSectors = 48, kParallelRings = 16;
  constexpr double kGrowth = 1.5;  // ratio of the radii of adjacent rings
  const Tangents<double> axes = tangents_of(normal);
  const double height = dot(view.eye - point, normal), cosine = dot(view.forward, normal);
  if (view.parallel ? cosine == 0 : height == 0) return;  // seen edge-on
  const Vec3d middle = view.eye - (view.parallel ? view.forward * (height / cosine) : normal * height);
  std::vector<double> radii{0};
  if (view.parallel) {
    const double radius = 1.01 * view.reach / std::abs(cosine);  // a polygon of 48 sides covers the view
    for (int ring = 1; ring <= kParallelRings; ++ring) radii.push_back(radius * ring / kParallelRings);
  } else {
    const double last = view.vanishing_distance(std::abs(height));
    for (double radius = std::abs(height) / 2; radii.back() < last; radius *= kGrowth)
      radii.push_back(radius);
    out.error = std::max(out.error, view.max_error);
  }
  out.add_rings(primitive, static_cast<int>(radii.size()), kSectors, [&](int ring, const SineCosine& turn) {
    const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
    return Tessellation::Vertex{middle + across * radii[static_cast<std::size_t>(ring)], normal};
  });
}

ShapeType plane_type() { return {"plane", "An infinite plane.", make_shape_set<Plane>}; }

}  // namespace orrery
