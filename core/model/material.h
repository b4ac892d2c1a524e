#pragma once

#include <limits>
#include <memory>

#include "core/model/draws.h"
#include "core/model/rounding.h"

// Materials. As with shapes, a scene keeps all materials of one type together and makes a kernel of them in
// the plan's number type. Radiance and coefficients are linear, per channel.
namespace orrery {

class Params;

// What a perfectly specular material does with the light along the ray: weights of the mirrored and of the
// refracted ray (0: none) and the direction of the latter; `filter` is what remains of light that crossed the
// body from the last surface to this one.
template <class T>
struct SpecularBatch {
  Vec3Array<T> reflectance, transmittance, refracted, filter;
};

// Two directions at each surface point: that of the ray which met it, and one away from it.
template <class T>
struct Directions {
  const Vec3Array<T>& ray;     // unit, toward the surface
  const Vec3Array<T>& light;   // unit, away from the surface
  const Array<T>& reach;       // metres along `light`; lanes without a positive number are not asked for
  bool constant_half = false;  // both directions are the same for the whole batch
};

// Which lobes of a material are meant. Diffuse: light that leaves all over the side it came from, as
// Lambert's law has it or nearly so. All others mirror or transmit, perfectly or not.
enum class Lobes { all, diffuse, non_diffuse };
constexpr bool with_diffuse(Lobes lobes) { return lobes != Lobes::non_diffuse; }
constexpr bool with_non_diffuse(Lobes lobes) { return lobes != Lobes::diffuse; }

// One direction drawn at each surface point.
template <class T>
struct ScatterBatch {
  Vec3Array<T> direction;  // unit, away from the surface
  Vec3Array<T> weight;     // reflected share of radiance times cosine over density; 0: nothing goes on
  Array<T> pdf;            // density per solid angle; 0 of a direction that no other could be
};

// Const and free of state: any number of threads may call it at once. `lobes` are at least one of those that
// the traits of its materials have.
template <class T>
class MaterialKernel {
 public:
  virtual ~MaterialKernel() = default;

  // Sets `radiance` of the lanes with this material to what `ambient` light alone makes leave the surface.
  virtual void ambient(const RayBatch<T>&, const SurfaceBatch<T>&, const Groups&, Lobes,
                       const Vec3<T>& /*ambient*/, Vec3Array<T>& /*radiance*/) const {}

  // Light along `directions.light` that leaves toward the ray's origin: `f_cos` is the share per channel,
  // cosine included, times pi (a white Lambert surface: the cosine); `pdf` the density per solid angle with
  // which sample() draws that direction. Both are set for the lanes with this material alone; pdf is 0, and
  // f_cos undefined, where nothing is reflected.
  virtual void evaluate(const Directions<T>&, const SurfaceBatch<T>&, const Groups&, Lobes,
                        Vec3Array<T>& /*f_cos*/, Array<T>& /*pdf*/) const {}

  // Draws one direction in which light may have come, for the lanes with this material.
  virtual void sample(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>&, const PathDraws<T>&,
                      const Groups&, Lobes, ScatterBatch<T>&) const {}

  // All directions of a perfectly specular material, for the lanes with it.
  virtual void specular(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>&, const Groups&,
                        SpecularBatch<T>&) const {}
};

template <class T>
using MaterialKernelPtr = std::unique_ptr<MaterialKernel<T>>;

struct MaterialTraits {
  bool lit = false;          // answers light sources: `ambient` and `evaluate`
  bool mirrors = false;      // `specular` may have reflectance
  bool transmits = false;    // light passes through: `specular` may have transmittance, `evaluate` may answer
                             // light from behind
  bool filters = false;      // light may be weakened on its way through the body
  bool glossy = false;       // some may look different from different sides, though they answer light sources
  bool diffuse = false;      // some have a diffuse lobe
  bool non_diffuse = false;  // some have another one
  bool emits = false;        // some surface with it sends light out by itself
  SurfaceFields fields = {};  // that `evaluate` and `sample` read

  MaterialTraits& operator|=(const MaterialTraits& other) {
    lit |= other.lit;
    mirrors |= other.mirrors;
    transmits |= other.transmits;
    filters |= other.filters;
    glossy |= other.glossy;
    diffuse |= other.diffuse;
    non_diffuse |= other.non_diffuse;
    emits |= other.emits;
    fields |= other.fields;
    return *this;
  }

  // Whether some may have one of these lobes.
  bool has(Lobes lobes) const {
    return lobes == Lobes::all || (lobes == Lobes::diffuse ? diffuse : non_diffuse);
  }
};

// The most that a surface sends on, per channel, whatever the directions. Where it mirrors a share R besides,
// `ambient` and `light` are what it sends on at R = 0, and at most 1 - R of that.
struct ReflectionLimits {
  Vec3d ambient{1.0};                                    // of ambient light
  Vec3d light{std::numeric_limits<double>::infinity()};  // f_cos of MaterialKernel::evaluate()
  Vec3d albedo{1.0};                                     // of light from everywhere
  bool specular = false;                                 // it may mirror and refract everything
};

class MaterialSet {
 public:
  virtual ~MaterialSet() = default;
  virtual void add(Params& params) = 0;
  virtual int size() const = 0;
  virtual MaterialTraits traits() const = 0;  // of all of them together
  virtual RoundingLimit rounding(int /*index*/) const { return {}; }
  // Largest share of light along the normal that it mirrors.
  virtual double mirrored_share(int /*index*/) const { return 0; }
  // Largest share of light that it sends on, over views and channels; above 1 it creates energy. To within a
  // hundredth; 1 of what keeps or loses energy by its formula.
  virtual double most_reflected(int /*index*/) const { return 1; }
  virtual ReflectionLimits limits(int /*index*/) const { return {}; }
  // Kernels whose materials are numbered from `first`.
  virtual MaterialKernelPtr<float> kernel(float, int first) const = 0;
  virtual MaterialKernelPtr<double> kernel(double, int first) const = 0;
};

struct MaterialType {
  const char* name;
  const char* summary;
  std::unique_ptr<MaterialSet> (*make)();
};

}  // namespace orrery
