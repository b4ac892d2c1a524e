#pragma once

#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// Reflected light of light sources. The caller fills `light`. find() then evaluates the materials and traces
// shadow rays. Not thread-safe: each object owns its batches. Objects on several threads may share the
// geometry, accelerator and plan.
template <class T>
class ShadowedLight {
 public:
  // `apart`: diffuse lobes are evaluated separately. Geometry, accelerator and plan must outlive this object.
  ShadowedLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan,
                bool apart = false)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan), apart_(apart) {}

  // Evaluates the materials of `groups` and traces shadow rays for lanes that reflect light. Returns the
  // registers with such lanes. With Plan::media, light.incident is attenuated inside bodies. Afterwards
  // light.shadow.t_max is positive in lanes whose light is reflected and not occluded. Without Plan::shadows,
  // no light counts as occluded. constant_half: see Directions.
  //
  // With SurfaceFields::smooth, a smooth triangle also reflects light that its interpolated normal faces and
  // its plane does not. The shadow ray of such light starts at the curved surface. Light counts as occluded
  // if the way from the triangle to this point, or from there to the light, is blocked. Closed bodies
  // therefore let no light in. MaterialKernel::sample() does not sample such directions, so `pdf` is 0.
  LaneGroups find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                  bool constant_half, TraceCounts& counts);

  LightBatch<T> light;
  // Results of MaterialKernel::evaluate(). Undefined outside the registers that find() returned.
  Vec3Array<T> pi_bsdf_cos;
  Array<T> pdf;
  // Results for diffuse lobes if `apart`. pi_bsdf_cos and pdf are then the results for the other lobes.
  Vec3Array<T> diffuse;
  Array<T> diffuse_pdf;

 private:
  // Evaluates the diffuse lobes. Sets `diffuse` and pi_bsdf_cos to 0 in lanes whose density is 0.
  void evaluate_diffuse(const Directions<T>& directions, const SurfaceBatch<T>& surface,
                        const LaneGroups& groups);
  // Moves the origins of shadow rays that leave below the plane of their triangle to the curved surface, and
  // points them at the light. Fills `lifts_` and returns its registers.
  LaneGroups lift(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const LaneGroups& groups);
  // Attenuates the light of shadow rays by the medium that they start in. They do not leave it, because they
  // pass no surfaces.
  void attenuate(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const LaneGroups& groups);
  // Ends the shadow rays whose lift is blocked.
  void trace_lifts(const LaneGroups& lifted, std::uint64_t& rays, AcceleratorCounts& counts);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  bool apart_;
  RayBatch<T> lifts_;  // from triangles to their curved surfaces; t_max is 0 in other lanes
};

// Sets pi_bsdf_cos and pdf of the lanes of `groups` for these lobes of their materials. In lanes whose
// material is not lit or lacks the lobes, pdf is 0 and pi_bsdf_cos is unchanged.
template <class T>
void evaluate_materials(const Geometry<T>& geometry, const Directions<T>& directions,
                        const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
                        Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) {
  for (const int i : groups) pdf.put(i, Lanes<T>(T(0)));
  for (const auto& m : geometry.materials)
    if (m.traits.lit && m.traits.has(lobes))
      m.kernel->evaluate(directions, surface, groups, lobes, pi_bsdf_cos, pdf);
}

// Samples a direction of these lobes for the lanes of `groups`. In lanes whose material lacks the lobes, the
// weight is 0 and the other members are unchanged. REQUIRES: all lanes with a material have a surface.
template <class T>
void sample_materials(const Geometry<T>& geometry, const RayBatch<T>& rays, const HitBatch<T>& hits,
                      const SurfaceBatch<T>& surface, const PathDraws<T>& draws, const LaneGroups& groups,
                      Lobes lobes, ScatterBatch<T>& out) {
  if (lobes != Lobes::all)
    for (const int i : groups) out.weight.put(i, Vec3<Lanes<T>>(Lanes<T>(T(0))));
  for (const auto& m : geometry.materials)
    if (m.traits.has(lobes)) m.kernel->sample(rays, hits, surface, draws, groups, lobes, out);
}

// Sets the radiance of lanes of `groups` to reflected ambient light, if their material is lit and has these
// lobes.
template <class T>
void add_ambient(const Geometry<T>& geometry, const RayBatch<T>& rays, const SurfaceBatch<T>& surface,
                 const LaneGroups& groups, Lobes lobes, Vec3Array<T>& radiance) {
  for (const auto& m : geometry.materials)
    if (m.traits.lit && m.traits.has(lobes))
      m.kernel->ambient(rays, surface, groups, lobes, geometry.ambient, radiance);
}

extern template class ShadowedLight<float>;
extern template class ShadowedLight<double>;

}  // namespace orrery
