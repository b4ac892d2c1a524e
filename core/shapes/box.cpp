#include "core/shapes/box.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

template <class N>
void Box<N>::read(Params& p, std::vector<Box<double>>& out) {
  const Vec3d lo = p.point("min", "Corner with the smallest coordinates, in metres.");
  const Vec3d hi = p.point("max", "Corner with the largest coordinates, in metres.");
  if (!(lo.x < hi.x && lo.y < hi.y && lo.z < hi.z))
    p.fail("max", "must be larger than min in every coordinate");
  out.push_back({lo, hi, Boundsd::of({lo, hi}).magnitude()});
}

template <class N>
void Box<N>::tessellate(const TessellationView&, int primitive, Tessellation& out) const {
  // Corner i is at `hi` along x, y and z where bits 0, 1 and 2 of i are set.
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  for (const Vec3d& corner : corners_of(bounds())) out.add(corner);
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [i, j, k, l] : kFaces) out.add_quad(primitive, first + i, first + j, first + k, first + l);
}

ShapeType box_type() { return {"box", "An axis-aligned box.", make_shape_set<Box>}; }

}  // namespace orrery
