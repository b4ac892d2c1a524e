#include "core/lighting/surfaces.h"

#include <algorithm>

#include "core/lighting/lane_masks.h"
#include "core/lighting/textures.h"

namespace orrery {
namespace {

template <class T>
void find_objects(const Scene& scene, const LaneGroups& groups, HitBatch<T>& hits, SurfaceBatch<T>& surface) {
  const auto resting = scene.object_count - static_cast<int>(scene.instances.size());
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      surface.object[lane] = -1;
      hits.instance[lane] = kNoInstance;
      const IndexOf<T> primitive = hits.primitive[lane];
      if (primitive == kNoPrimitive) continue;
      surface.object[lane] = scene.object_runs[scene.object_run_of(primitive)].object;
      if (surface.object[lane] >= resting) hits.instance[lane] = surface.object[lane] - resting;
    }
}

template <class T>
void find_footprints(const PathBatch<T>& paths, const LaneGroups& groups, const HitBatch<T>& hits,
                     SurfaceBatch<T>& surface) {
  for (const int i : groups) surface.footprint.put(i, paths.width.at(i) + paths.spread.at(i) * hits.t.at(i));
}

// Light from behind a material that transmits is not an error of its facets, so its lanes keep the geometric
// normal.
template <class T>
void find_smooth(const Geometry<T>& geometry, const PathBatch<T>& paths, const LaneGroups& groups,
                 const HitBatch<T>& hits, SurfaceBatch<T>& surface) {
  using N = Lanes<T>;
  const Vec3<N> none(N(T(0)));
  for (const int i : groups) {
    surface.smooth.put(i, surface.geometric.at(i));
    surface.lift.put(i, none);
  }
  for (const auto& shapes : geometry.shapes) shapes->smooth(paths.rays, hits, groups, surface);
  for (const int i : groups) {
    const auto transmits = lanes_with(geometry, surface, i, &MaterialTraits::transmits);
    if (!any(transmits)) continue;
    surface.smooth.put(i, transmits, surface.geometric.at(i));
    surface.lift.put(i, transmits, none);
  }
}

}  // namespace

template <class T>
LaneGroups start_surfaces(const Geometry<T>& geometry, const LaneGroups& groups, const HitBatch<T>& hits,
                          SurfaceBatch<T>& surface, Vec3Array<T>& radiance) {
  using N = Lanes<T>;
  LaneGroups met;
  const Vec3<N> background(geometry.background);
  const N zero(T(0));
  for (const int i : groups) {
    const auto missed = missed_lanes(hits, i);
    radiance.put(i, select(missed, background, Vec3<N>(zero)));
    if (all(missed)) continue;
    met.add(i);
    find_materials(geometry, hits, i, surface);
  }
  return met;
}

template <class T>
void add_fields(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                const LaneGroups& met, HitBatch<T>& hits, SurfaceBatch<T>& surface) {
  if (fields.parameters)
    for (const auto& shapes : geometry.shapes) shapes->parameters(paths.rays, met, hits, surface);
  if (fields.identity) find_objects(*geometry.scene, met, hits, surface);
  if (fields.footprint) find_footprints(paths, met, hits, surface);
  if (fields.travelled)
    for (const int i : met) surface.travelled.put(i, hits.t.at(i));
  if (fields.smooth) find_smooth(geometry, paths, met, hits, surface);
  if (fields.color) {
    for (const int i : met) surface.color.put(i, Vec3<Lanes<T>>(Lanes<T>(T(1))));
    for (const auto& shapes : geometry.shapes) shapes->colors(paths.rays, hits, met, surface);
  }
  if (geometry.textures) geometry.textures->apply(geometry, paths, met, hits, surface);
}

template <class T>
LaneGroups find_surfaces(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                         const LaneGroups& groups, HitBatch<T>& hits, SurfaceBatch<T>& surface,
                         Vec3Array<T>& radiance) {
  const LaneGroups met = start_surfaces(geometry, groups, hits, surface, radiance);
  for (const auto& shapes : geometry.shapes) shapes->surface(paths.rays, hits, met, surface);
  add_fields(geometry, fields, paths, met, hits, surface);
  return met;
}

template LaneGroups start_surfaces(const Geometry<float>&, const LaneGroups&, const HitBatch<float>&,
                                   SurfaceBatch<float>&, Vec3Array<float>&);
template LaneGroups start_surfaces(const Geometry<double>&, const LaneGroups&, const HitBatch<double>&,
                                   SurfaceBatch<double>&, Vec3Array<double>&);
template void add_fields(const Geometry<float>&, const SurfaceFields&, const PathBatch<float>&,
                         const LaneGroups&, HitBatch<float>&, SurfaceBatch<float>&);
template void add_fields(const Geometry<double>&, const SurfaceFields&, const PathBatch<double>&,
                         const LaneGroups&, HitBatch<double>&, SurfaceBatch<double>&);
template LaneGroups find_surfaces(const Geometry<float>&, const SurfaceFields&, const PathBatch<float>&,
                                  const LaneGroups&, HitBatch<float>&, SurfaceBatch<float>&,
                                  Vec3Array<float>&);
template LaneGroups find_surfaces(const Geometry<double>&, const SurfaceFields&, const PathBatch<double>&,
                                  const LaneGroups&, HitBatch<double>&, SurfaceBatch<double>&,
                                  Vec3Array<double>&);

}  // namespace orrery
