#pragma once

#include <memory>

#include "core/model/batch.h"
#include "core/model/light.h"

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

// Const and free of state.
template <class T>
class MaterialKernel {
 public:
  virtual ~MaterialKernel() = default;

  // Sets `radiance` of the lanes with this material to what `ambient` light alone makes leave the surface.
  virtual void ambient(const SurfaceBatch<T>& surface, const Groups& groups, const Vec3<T>& ambient,
                       Vec3Array<T>& radiance) const;

  // Light of one source that leaves toward the ray's origin, into `light.radiance`. Lanes that get none, and
  // lanes of other materials in the group, are left with light.t_max = -1 unless another material set them.
  virtual void reflect(const RayBatch<T>& rays, const SurfaceBatch<T>& surface, const Groups& groups,
                       LightBatch<T>& light) const;

  // Fills `out` for the lanes with this material.
  virtual void specular(const RayBatch<T>& rays, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                        const Groups& groups, SpecularBatch<T>& out) const;
};

template <class T>
using MaterialKernelPtr = std::unique_ptr<MaterialKernel<T>>;

struct MaterialTraits {
  bool lit = false;        // answers light sources: `ambient` and `reflect`
  bool mirrors = false;    // `specular` may have reflectance
  bool transmits = false;  // `specular` may have transmittance
  bool filters = false;    // `specular` may have a filter other than 1
};

class MaterialSet {
 public:
  virtual ~MaterialSet() = default;
  virtual void add(Params& params) = 0;
  virtual int size() const = 0;
  virtual MaterialTraits traits() const = 0;  // of all of them together
  // Kernels whose materials are numbered from `first`.
  virtual MaterialKernelPtr<float> kernel(float, int first) const = 0;
  virtual MaterialKernelPtr<double> kernel(double, int first) const = 0;
};

struct MaterialType {
  const char* name;
  const char* summary;
  std::unique_ptr<MaterialSet> (*make)();
};

template <class T>
void MaterialKernel<T>::ambient(const SurfaceBatch<T>&, const Groups&, const Vec3<T>&, Vec3Array<T>&) const {}
template <class T>
void MaterialKernel<T>::reflect(const RayBatch<T>&, const SurfaceBatch<T>&, const Groups&,
                                LightBatch<T>&) const {}
template <class T>
void MaterialKernel<T>::specular(const RayBatch<T>&, const HitBatch<T>&, const SurfaceBatch<T>&,
                                 const Groups&, SpecularBatch<T>&) const {}

}  // namespace orrery
