#pragma once

#include "core/materials/fresnel.h"
#include "core/math/elementary.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

// Smooth glass that mirrors and refracts, and may absorb light inside.
template <class N>
struct Refractive {
  N ior;                           // index of refraction inside / outside, with air outside as read
  N f0;                            // reflectance along the normal
  N exact;                         // 1: Fresnel's equations, 0: Schlick's approximation
  Vec3<N> log2_filter;             // log2 of the transmittance per metre inside
  N priority = N(ScalarOf<N>(0));  // see Medium

  static Refractive<double> read(Params& p);
  MaterialTraits traits() const {
    return {.mirrors = true, .transmits = true, .filters = log2_filter != Vec3<N>(N(0)), .non_diffuse = true};
  }
  ReflectionLimits limits() const { return {Vec3d(0), Vec3d(0), Vec3d(1), true}; }
  double mirrored_share() const { return f0; }
  Medium medium() const {
    Medium inside;
    inside.ior = ior;
    inside.priority = priority;
    inside.log2_filter = log2_filter;
    return inside;
  }

  // Returns the material with the media on both sides of the surfaces in register i, without the filter that
  // the technique then applies: see SurfaceBatch::relative_index.
  template <class T>
  Refractive between_media(const SurfaceBatch<T>& surface, int i) const {
    if (!surface.relative_index) return *this;
    const N index = surface.relative_index->at(i), zero(T(0));
    return {index, select(index == ior, f0, normal_reflectance(index, zero)), exact, Vec3<N>(zero), priority};
  }

  struct Split {
    N reflectance;
    Vec3<N> refracted;  // unit; undefined on total reflection
  };
  // Applies Snell's law to a ray that comes from inside or outside. The reflectance is 1 beyond the critical
  // angle.
  Split split(const Vec3<N>& direction, const Vec3<N>& normal, const MaskOf<N>& inside) const {
    using std::sqrt;
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const N eta = select(inside, ior, N(one / ior));
    const N cos_incident = min_first(one, max_first(zero, N(-dot(direction, normal))));
    const N cos2_transmitted = one - eta * eta * (one - cos_incident * cos_incident);
    const auto total = !(cos2_transmitted > zero);
    const N cos_transmitted = sqrt(select(total, zero, cos2_transmitted));
    const N thinner = select(eta > one, cos_transmitted, cos_incident);
    N r = fresnel_schlick(f0, thinner);
    const auto equations = exact > zero;
    if (any(equations)) r = select(equations, fresnel_dielectric(eta, cos_incident, cos_transmitted), r);
    return {select(total, one, r),
            normalize(direction * eta + normal * (eta * cos_incident - cos_transmitted))};
  }

  // Returns the transmittance after `depth` metres inside.
  Vec3<N> filter(const N& depth) const { return transmittance_of(log2_filter, depth); }
  // Returns the transmittance over `travelled` metres in lanes where the ray arrives from inside, else 1.
  // `travelled` may be uninitialised if no material filters.
  Vec3<N> body_transmittance(const MaskOf<N>& is_inside, const N& travelled) const {
    const N zero(ScalarOf<N>(0));
    const auto filters = is_inside && max_component(-log2_filter) > zero;
    if (!any(filters)) return Vec3<N>(N(ScalarOf<N>(1)));
    return filter(select(filters, travelled, zero));
  }
};

// Reads Medium::priority.
double read_priority(Params& p);

// Returns Refractive::log2_filter for a transmittance per metre.
template <class N>
Vec3<N> log2_filter_of(const Vec3<N>& filter) {
  const auto log2_of = [](const N& x) -> N {
    using T = ScalarOf<N>;
    const auto opaque = x < N(std::numeric_limits<T>::min());
    return select(opaque, N(T(-1e30)), log2_normal(select(opaque, N(T(1)), x)));
  };
  return {log2_of(filter.x), log2_of(filter.y), log2_of(filter.z)};
}

}  // namespace orrery
