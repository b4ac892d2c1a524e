#pragma once

#include "core/model/path.h"
#include "core/model/world.h"

// core/lighting contains the lighting stages of techniques. A stage processes whole batches of rays.
// Functions are thread-safe. Objects that own batches are not thread-safe, so each thread needs separate
// objects. Stages throw nothing except std::bad_alloc. Building a LightTree also throws Cancelled.
namespace orrery {

// Resets the hits of `groups`: t to t_max, and the primitive to kNoPrimitive.
template <class T>
void reset(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits) {
  for (const int i : groups) {
    hits.t.put(i, rays.t_max.at(i));
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
}

// Sets the materials of register i, or -1 for rays that missed. Fast if all rays hit the same primitive,
// which is the most frequent case.
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

// Sets the materials of every hit in `groups`. Sets `radiance` to the background for rays that missed, else
// to 0. Returns the registers with a hit.
template <class T>
LaneGroups start_surfaces(const Geometry<T>& geometry, const LaneGroups& groups, const HitBatch<T>& hits,
                          SurfaceBatch<T>& surface, Vec3Array<T>& radiance);
// Sets the requested optional fields of every hit in `met`, and evaluates textures. REQUIRES: positions and
// normals are set.
template <class T>
void add_fields(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                const LaneGroups& met, HitBatch<T>& hits, SurfaceBatch<T>& surface);
// Sets the surface of every hit in `groups`, with the requested `fields`. Sets `radiance` to the background
// for rays that missed, else to 0. Returns the registers with a surface.
template <class T>
LaneGroups find_surfaces(const Geometry<T>& geometry, const SurfaceFields& fields, const PathBatch<T>& paths,
                         const LaneGroups& groups, HitBatch<T>& hits, SurfaceBatch<T>& surface,
                         Vec3Array<T>& radiance);

}  // namespace orrery
