#pragma once

#include "core/model/path.h"
#include "core/model/world.h"

namespace orrery {

// Finds what the rays of `groups` meet first, from hits that were reset() to their rays.
template <class T>
void reset(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits) {
  for (const int i : groups) {
    hits.t.put(i, rays.t_max.at(i));
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
}

// Sets the materials of register i; -1 of rays that met nothing. (Neighbours mostly meet the same primitive.)
template <class T>
void find_materials(const Geometry<T>& geometry, const HitBatch<T>& hits, int i, SurfaceBatch<T>& surface) {
  const auto material = [&](IndexOf<T> p) {
    return p < 0 ? -1 : geometry.material_of[static_cast<std::size_t>(p)];
  };
  const IndexLanes<T> primitive = load_index<T>(hits.primitive, i);
  const IndexOf<T> first = primitive[0];
  if (all(primitive == first)) return surface.material.put(i, IndexLanes<T>(material(first)));
  for (int lane = i; lane < i + kWidth<T>; ++lane) surface.material[lane] = material(hits.primitive[lane]);
}

// Fills the surface of every hit in `groups`, and of `fields` what is asked for; sets `radiance` to the
// background for rays that met nothing and to 0 for the others. Returns the registers with a surface.
template <class T>
Groups find_surfaces(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                     const Groups& groups, HitBatch<T>& hits, SurfaceBatch<T>& surface,
                     Vec3Array<T>& radiance);

}  // namespace orrery
