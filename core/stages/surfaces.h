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

// Fills the surface of every hit in `groups`, and of `fields` what is asked for; sets `radiance` to the
// background for rays that met nothing and to 0 for the others. Returns the registers with a surface.
template <class T>
Groups find_surfaces(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                     const Groups& groups, HitBatch<T>& hits, SurfaceBatch<T>& surface,
                     Vec3Array<T>& radiance);

}  // namespace orrery
