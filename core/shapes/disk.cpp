#include "core/shapes/disk.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Disk<N>::read(Params& p, std::vector<Disk<double>>& out) {
  const Vec3d center = p.point("center", "Centre, in metres.");
  const Vec3d normal = p.direction("normal", "Normal of the front side.");
  const double radius = p.positive("radius", "Radius, in metres.");
  out.push_back({center, normal, radius, max_component(abs(center)) + radius});
}

template <class N>
void Disk<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  const Vec3d from_center = view.eye - center;
  const double distance = std::max(length(from_center) - radius, std::abs(dot(from_center, normal)));
  const Tangents<double> axes = tangents_of(normal);
  out.add_rings(primitive, 2, out.sides(view, radius, view.pixel_at(distance)),
                [&](int ring, const SineCosine& turn) {
                  const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
                  return Tessellation::Vertex{center + across * (ring * radius), normal};
                });
}

ShapeType disk_type() { return {"disk", "A flat disk.", make_shape_set<Disk>}; }

}  // namespace orrery
