#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "core/model/draws.h"
#include "core/model/media.h"
#include "core/model/rounding.h"
#include "core/model/texture.h"

// Materials. A scene stores all materials of one type in a MaterialSet, which creates a kernel in the plan's
// number type. Radiance and coefficients are linear, per channel.
namespace orrery {

class Params;

// Perfectly specular scattering at each surface point: weights of the mirrored and the refracted ray (0: no
// ray), and the unit direction of the refracted ray. `filter` is the transmittance, per channel, from the
// origin of the incoming ray to the surface: 1 unless the ray arrives from inside the material.
template <class T>
struct SpecularBatch {
  Vec3Array<T> reflectance, transmittance, refracted, filter;
};

// Pair of directions at each surface point: the incoming ray, and a direction away from the surface.
template <class T>
struct Directions {
  const Vec3Array<T>& ray;     // unit, toward the surface
  const Vec3Array<T>& light;   // unit, away from the surface
  const Array<T>& reach;       // metres along `light`; lanes with reach <= 0 are skipped
  bool constant_half = false;  // both directions are constant over the batch
  bool smooth = false;         // SurfaceBatch::smooth may decide which side light comes from

  // Returns values that are positive in lanes whose light comes from the viewer's side of the surface: the
  // cosine at the geometric normal. With `smooth`, the larger of the cosines at both normals.
  [[gnu::always_inline]] Lanes<T> side_cosine(const SurfaceBatch<T>& surface, int i) const {
    const Vec3<Lanes<T>> toward = light.at(i);
    const Lanes<T> flat = dot(surface.geometric.at(i), toward);
    return smooth ? max_first(flat, dot(surface.smooth.at(i), toward)) : flat;
  }
};

// Selection of a material's lobes. Diffuse lobes reflect over the whole hemisphere on the incident side,
// Lambertian or nearly so. Non-diffuse lobes mirror or transmit, perfectly or not.
enum class Lobes { all, diffuse, non_diffuse };
constexpr bool with_diffuse(Lobes lobes) { return lobes != Lobes::non_diffuse; }
constexpr bool with_non_diffuse(Lobes lobes) { return lobes != Lobes::diffuse; }

// Sampled direction at each surface point.
template <class T>
struct ScatterBatch {
  Vec3Array<T> direction;  // unit, away from the surface
  Vec3Array<T> weight;     // BSDF times cosine, divided by the density; 0: nothing is scattered
  Array<T> pdf;            // density per solid angle; 0 for perfectly specular directions
};

// Scattering functions of all materials of one type. Immutable and thread-safe. REQUIRES:
// MaterialTraits::has() of these materials returns true for the argument `Lobes`.
template <class T>
class MaterialKernel {
 public:
  virtual ~MaterialKernel() = default;

  // Sets `radiance` to the light that the surface reflects under `ambient` light alone, for the lanes with
  // these materials.
  virtual void ambient(const RayBatch<T>&, const SurfaceBatch<T>&, const LaneGroups&, Lobes,
                       const Vec3<T>& /*ambient*/, Vec3Array<T>& /*radiance*/) const {}

  // Evaluates scattering from `directions.light` toward the ray's origin. `pi_bsdf_cos` is pi times the BSDF
  // times the cosine, per channel: the cosine for a white Lambert surface. `pdf` is the density per solid
  // angle with which sample() samples the direction. Sets only the lanes with these materials. If nothing is
  // scattered, `pdf` is 0 and `pi_bsdf_cos` is undefined.
  virtual void evaluate(const Directions<T>&, const SurfaceBatch<T>&, const LaneGroups&, Lobes,
                        Vec3Array<T>& /*pi_bsdf_cos*/, Array<T>& /*pdf*/) const {}

  // Samples one direction of incident light, for the lanes with these materials.
  virtual void sample(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>&, const PathDraws<T>&,
                      const LaneGroups&, Lobes, ScatterBatch<T>&) const {}

  // Computes perfectly specular reflection and refraction, for the lanes with these materials.
  virtual void specular(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>&, const LaneGroups&,
                        SpecularBatch<T>&) const {}
};

template <class T>
using MaterialKernelPtr = std::unique_ptr<MaterialKernel<T>>;

// Traits of one material, or the union of the traits of several materials.
struct MaterialTraits {
  bool lit = false;           // scatters light from light sources: `ambient` and `evaluate` apply
  bool mirrors = false;       // `specular` may have reflectance
  bool transmits = false;     // `specular` may transmit, or `evaluate` may scatter light from behind
  bool filters = false;       // may absorb light that travels inside an object
  bool glossy = false;        // lit, with a radiance that may depend on the view direction
  bool diffuse = false;       // has a diffuse lobe
  bool non_diffuse = false;   // has a non-diffuse lobe
  bool emits = false;         // surfaces with the material emit light
  bool straight = false;      // transmits without refraction: SpecularBatch::refracted continues the ray
  SurfaceFields fields = {};  // surface fields that `evaluate` and `sample` read

  MaterialTraits& operator|=(const MaterialTraits& other) {
    lit |= other.lit;
    mirrors |= other.mirrors;
    transmits |= other.transmits;
    filters |= other.filters;
    glossy |= other.glossy;
    diffuse |= other.diffuse;
    non_diffuse |= other.non_diffuse;
    emits |= other.emits;
    straight |= other.straight;
    fields |= other.fields;
    return *this;
  }

  // Returns true if the material may have one of these lobes. Always true for Lobes::all.
  bool has(Lobes lobes) const {
    return lobes == Lobes::all || (lobes == Lobes::diffuse ? diffuse : non_diffuse);
  }
};

// Upper bounds on the light that a surface scatters, per channel, over all directions. If a material also
// mirrors a fraction R of the light, the bounds are `ambient` * (1 - R) and `light` * (1 - R).
struct ReflectionLimits {
  Vec3d ambient{1.0};                                    // reflected ambient light
  Vec3d light{std::numeric_limits<double>::infinity()};  // pi_bsdf_cos of MaterialKernel::evaluate()
  Vec3d albedo{1.0};                                     // reflected fraction of light from all directions
  bool specular = false;                                 // may also mirror and refract all light
  // Fraction of the light from behind that passes in addition to the bounds above, which it does not reduce.
  Vec3d transmitted{0.0};
};

// All materials of one type. add() is called by one thread while the scene is loaded, records problems in
// `params`, and throws Cancelled. The other functions are thread-safe afterwards.
class MaterialSet {
 public:
  virtual ~MaterialSet() = default;
  virtual void add(Params& params, const TextureNames& textures) = 0;
  virtual int size() const = 0;
  // Returns the textured parameters of a material. The other functions bound them by the bounds of the
  // textures.
  virtual std::vector<TextureUse> texture_uses(int /*index*/) const { return {}; }
  virtual MaterialTraits traits() const = 0;  // union over the set
  virtual RoundingLimit rounding(int /*index*/) const { return {}; }
  // Returns the fraction of light that is mirrored along the normal, for the channel with the largest
  // fraction.
  virtual double mirrored_share(int /*index*/) const { return 0; }
  // Returns 1 if the formula cannot create energy. Otherwise returns the largest albedo over view directions
  // and channels, to within 0.01. An albedo above 1 means that the material creates energy.
  virtual double max_albedo(int /*index*/) const { return 1; }
  virtual ReflectionLimits limits(int /*index*/) const { return {}; }
  // Returns the medium inside closed surfaces, or nullopt if light that passes the surface stays in the same
  // medium.
  virtual std::optional<Medium> medium(int /*index*/) const { return std::nullopt; }
  // Returns a kernel whose materials are numbered from `first`.
  virtual MaterialKernelPtr<float> kernel(float, int first) const = 0;
  virtual MaterialKernelPtr<double> kernel(double, int first) const = 0;
};

struct MaterialType {
  const char* name;
  const char* summary;
  std::unique_ptr<MaterialSet> (*make)();
};

}  // namespace orrery
