#include "core/lighting/shadowed_light.h"

#include <algorithm>
#include <limits>

namespace orrery {
namespace {

// Least height of a curved surface above its triangle, times SurfaceBatch::step. Lower heights are rounding
// errors of flat triangles, or belong to light that the triangle itself blocks.
constexpr int kLeastSteps = 4;

}  // namespace

template <class T>
void ShadowedLight<T>::evaluate_diffuse(const Directions<T>& directions, const SurfaceBatch<T>& surface,
                                        const LaneGroups& groups) {
  using N = Lanes<T>;
  const N zero(T(0));
  evaluate_materials(geometry_, directions, surface, groups, Lobes::diffuse, diffuse, diffuse_pdf);
  for (const int i : groups) {
    diffuse.put(i, !(diffuse_pdf.at(i) > zero), Vec3<N>(zero));
    pi_bsdf_cos.put(i, !(pdf.at(i) > zero), Vec3<N>(zero));
  }
}

template <class T>
LaneGroups ShadowedLight<T>::lift(const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                                  const LaneGroups& groups) {
  using N = Lanes<T>;
  const N zero(T(0)), one(T(1)), infinity(std::numeric_limits<T>::infinity());
  RayBatch<T>& shadow = light.shadow;
  LaneGroups lifted;
  for (const int i : groups) {
    const Vec3<N> toward = shadow.direction.at(i), geometric = surface.geometric.at(i);
    const N reach = shadow.t_max.at(i);
    const auto below =
        reach > zero && !(dot(geometric, toward) > zero) && dot(surface.smooth.at(i), toward) > zero;
    if (!any(below)) continue;
    const Vec3<N> way = surface.lift.at(i);
    const auto clear = below && dot(way, geometric) > surface.step.at(i) * T(kLeastSteps);
    pdf.put(i, below, zero);
    if (apart_) diffuse_pdf.put(i, below, zero);
    shadow.t_max.put(i, below && !clear, N(-one));
    if (!any(clear)) continue;
    lifted.add(i);
    const Vec3<N> from = surface.position.at(i) + geometric * surface.step.at(i), to = from + way;
    const N height = select(clear, length(way), one);
    lifts_.origin.put(i, from);
    lifts_.direction.put(i, way / height);
    lifts_.t_max.put(i, select(clear, height, zero));
    if (plan_.shutter > 0) lifts_.time.put(i, paths.rays.time.at(i));
    shadow.origin.put(i, clear, to);
    const auto near = clear && reach < infinity;
    const Vec3<N> line = surface.position.at(i) + toward * select(near, reach, one) - to;
    const N distance = length(line);
    shadow.direction.put(i, near, line / distance);
    shadow.t_max.put(i, near, distance);
  }
  return lifted;
}

template <class T>
void ShadowedLight<T>::trace_lifts(const LaneGroups& lifted, std::uint64_t& rays, AcceleratorCounts& counts) {
  using N = Lanes<T>;
  rays += active_rays(lifts_, lifted);
  accelerator_.occlude(lifts_, lifted, counts);
  for (const int i : lifted) light.shadow.t_max.put(i, lifts_.t_max.at(i) < N(T(0)), N(T(-1)));
}

template <class T>
void ShadowedLight<T>::attenuate(const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                                 const LaneGroups& groups) {
  const std::vector<Medium>& bodies = geometry_.scene->media.bodies;
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      if (!(light.shadow.t_max[lane] > 0)) continue;
      const bool crosses = dot(light.shadow.direction[lane], surface.geometric[lane]) < 0;
      const MediaLists& lists = crosses ? *surface.behind : *paths.media;
      const std::int32_t top = lists[static_cast<std::size_t>(lane)].top(bodies);
      if (top < 0 || bodies[static_cast<std::size_t>(top)].log2_filter == Vec3d(0)) continue;
      const Vec3<T> rate(bodies[static_cast<std::size_t>(top)].log2_filter);
      const T distance = std::min(light.shadow.t_max[lane], std::numeric_limits<T>::max());  // 0 * inf is NaN
      light.incident.set(lane, light.incident[lane] * transmittance_of(rate, distance));
    }
}

// Shadow rays start on the side of the surface that faces the light.
template <class T>
LaneGroups ShadowedLight<T>::find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                                  const LaneGroups& groups, bool constant_half, TraceCounts& counts) {
  using N = Lanes<T>;
  RayBatch<T>& shadow = light.shadow;
  const Directions<T> directions{paths.rays.direction, shadow.direction, shadow.t_max, constant_half,
                                 plan_.fields.smooth};
  evaluate_materials(geometry_, directions, surface, groups, apart_ ? Lobes::non_diffuse : Lobes::all,
                     pi_bsdf_cos, pdf);
  if (apart_) evaluate_diffuse(directions, surface, groups);
  LaneGroups reached;
  for (const int i : groups) {
    const N zero(T(0));
    auto lit = pdf.at(i) > zero;
    if (apart_) lit = lit || diffuse_pdf.at(i) > zero;
    shadow.t_max.put(i, !lit, N(T(-1)));
    if (!any(lit)) continue;
    reached.add(i);
    shadow.origin.put(i, surface.origin_toward(i, shadow.direction.at(i)));
    if (plan_.shutter > 0) shadow.time.put(i, paths.rays.time.at(i));
  }
  const LaneGroups lifted = plan_.fields.smooth ? lift(paths, surface, reached) : LaneGroups();
  if (plan_.shadows) {
    std::uint64_t& rays = counts.rays.shadow[static_cast<std::size_t>(paths.depth)];
    if (!lifted.empty()) trace_lifts(lifted, rays, counts.accelerator);
    rays += active_rays(shadow, reached);
    accelerator_.occlude(shadow, reached, counts.accelerator);
  }
  if (surface.behind) attenuate(paths, surface, reached);
  if (geometry_.atmosphere) geometry_.atmosphere->transmit_light(shadow.t_max, reached, light.incident);
  return reached;
}

template class ShadowedLight<float>;
template class ShadowedLight<double>;

}  // namespace orrery
