#include "core/shapes/cylinder.h"

#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/primitive_set.h"

namespace orrery {
namespace {

// Returns the heights along the axis at which an infinite cylinder is divided, in descending order. They are
// dense near the eye, which is `beside` metres from the wall. For parallel cameras, they cover the view. A
// cylinder that a parallel camera sees along its axis has one height.
std::vector<double> unbounded_heights(const TessellationView& view, const Cylinder<double>& cylinder,
                                      double beside) {
  constexpr int kParallelSteps = 8;
  constexpr double kGrowth = 1.5;  // ratio of adjacent heights
  const Vec3d from_center = view.eye - cylinder.center;
  double middle = dot(from_center, cylinder.axis);
  std::vector<double> heights{0};
  if (view.parallel) {
    const double cosine = dot(view.forward, cylinder.axis), square = 1 - cosine * cosine;
    if (!(square > 0)) return {0};
    middle = (middle - cosine * dot(from_center, view.forward)) / square;
    const double last = (view.reach + cylinder.radius) / std::sqrt(square);
    for (int step = 1; step <= kParallelSteps; ++step) heights.push_back(last * step / kParallelSteps);
  } else {
    const double first = beside > 0 ? beside : cylinder.radius;
    const double last = view.vanishing_distance(first + 2 * cylinder.radius);
    for (double height = first / 2; heights.back() < last; height *= kGrowth) heights.push_back(height);
  }
  std::vector<double> rings;
  for (std::size_t i = heights.size() - 1; i > 0; --i) rings.push_back(middle + heights[i]);
  for (const double height : heights) rings.push_back(middle - height);
  return rings;
}

}  // namespace

template <class N>
void Cylinder<N>::read(Params& p, std::vector<Cylinder<double>>& out) {
  const double infinity = std::numeric_limits<double>::infinity();
  if (p.form({{"base", "top"}, {"point", "axis"}}) == 0) {
    const Vec3d base = p.point("base", "Centre of one cap, in metres.");
    const Vec3d top = p.point("top", "Centre of the other cap, in metres.");
    const double radius = p.positive("radius", "Radius, in metres.");
    if (base == top) p.fail("top", "must differ from base");
    const double reach = std::max(max_component(abs(base)), max_component(abs(top))) + radius;
    out.push_back({(base + top) * 0.5, safe_normalize(top - base), radius, length(top - base) / 2, reach});
  } else {
    const Vec3d point = p.point("point", "Any point on the axis, in metres.");
    const Vec3d axis = p.direction("axis", "Direction of the axis of an infinite cylinder.");
    const double radius = p.positive("radius", "Radius, in metres.");
    out.push_back({point, axis, radius, infinity, max_component(abs(point)) + radius});
  }
}

template <class N>
void Cylinder<N>::tessellate(const TessellationView& view, int primitive, Tessellation& out) const {
  const Tangents<double> axes = tangents_of(axis);
  const Vec3d from_center = view.eye - center;
  const double along = dot(from_center, axis), from_axis = length(from_center - axis * along);
  const double beyond = std::max(std::abs(along) - half_length, 0.0), beside = std::abs(from_axis - radius);
  const double distance = std::max(from_axis < radius && beyond > 0 ? 0.0 : beside, beyond);
  const int sectors = out.sides(view, radius, view.pixel_at(distance));
  const std::vector<double> heights = std::isinf(half_length) ? unbounded_heights(view, *this, beside)
                                                              : std::vector{half_length, -half_length};
  out.add_rings(primitive, static_cast<int>(heights.size()), sectors, [&](int ring, const SineCosine& turn) {
    const Vec3d across = axes.first * turn.cosine + axes.second * turn.sine;
    return Tessellation::Vertex{center + axis * heights[static_cast<std::size_t>(ring)] + across * radius,
                                across};
  });
  if (std::isinf(half_length)) return;
  for (const double side : {1.0, -1.0})
    out.add_rings(primitive, 2, sectors, [&](int ring, const SineCosine& turn) {
      const Vec3d across = axes.first * turn.cosine + axes.second * (side * turn.sine);
      return Tessellation::Vertex{center + axis * (side * half_length) + across * (ring * radius),
                                  axis * side};
    });
}

ShapeType cylinder_type() {
  return {"cylinder", "A circular cylinder, with caps or infinitely long.", make_shape_set<Cylinder>};
}

}  // namespace orrery
