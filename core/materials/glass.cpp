#include "core/materials/glass.h"

#include "core/materials/glass_kernel.h"
#include "core/params/params.h"

namespace orrery {
namespace {

// Returns the approximate angular spread of refracted rays in radians, divided by alpha. Glass with a spread
// below kMinSpread is treated as smooth.
double spread_by_index(double ior) { return std::abs(std::log2(ior)); }
constexpr double kMinSpread = 1e-4;

// Returns the single-scattering albedo of facets that absorb nothing: only light that hits a second facet is
// missing.
FacetAlbedo<double> lossless_albedo(double alpha, double far_index) {
  const auto share = [&](const Vec3d& viewer, const Vec3d& normal, const auto& seen) {
    const double to_viewer = dot(viewer, normal), eta = 1 / far_index;
    const auto [mirrored, cos_transmitted] = split_dielectric(eta, to_viewer);
    const double back = mirrored_about(viewer, normal).z;
    const double on = eta * viewer.z - (eta * to_viewer - cos_transmitted) * normal.z;
    return (back > 0 ? mirrored * seen(back) : 0.0) + (on > 0 ? (1 - mirrored) * seen(on) : 0.0);
  };
  constexpr double kStepScale = 0.3;  // the step at the critical angle is sharp at any alpha
  return facet_albedo(alpha, far_index < 1 ? std::max(alpha, kStepScale) : alpha, share);
}

}  // namespace

// The transmitted fractions of multiple scattering follow from the mean Fresnel reflectance F. They are
// scaled so that both are at most 1 and f / n^2 is symmetric: see Glass. F is computed on the optically
// thinner side, which has no total reflection. n^2 (1 - F) is equal on both sides.
template <>
void GlassInputs<double>::tabulate(double of_roughness) {
  alpha = of_roughness * of_roughness;
  if (alpha < kMinAlpha || alpha * spread_by_index(ior) < kMinSpread) {
    alpha = 0;
    return;
  }
  outside = lossless_albedo(alpha, ior);
  inside = lossless_albedo(alpha, 1 / ior);
  const double left_outside = 1 - outside.mean, left_inside = 1 - inside.mean;
  const double passes = ior > 1 ? 1 - mean_dielectric(1 / ior) : (1 - mean_dielectric(ior)) * ior * ior;
  const double most = std::max({left_outside, left_inside, std::numeric_limits<double>::min()});
  through_outside = passes * left_inside / most;
  through_inside = passes / (ior * ior) * left_outside / most;
}

template <>
void GlassInputs<double>::read_boundary(MaterialParams& p) {
  ior = p.plain().number("ior", "Index of refraction; air: 1.", {.min = 0.1, .max = 10}, 1.5);
  p.number(roughness, "roughness",
           "Roughness from 0 (smooth) to 1; its square is the alpha of the GGX distribution.",
           {.min = 0, .max = 1}, 0.0);
  priority = read_priority(p.plain());
  if (p.raise_texture(roughness, kMinTexturedRoughness)) {
    roughness = kMinTexturedRoughness;
    if (kMinAlpha * spread_by_index(ior) < kMinSpread)
      p.plain().fail("roughness", "cannot be textured if ior is from 0.933 to 1.071 (got " +
                                      number_text(ior) + "), because such glass is smooth");
  }
}

template <>
void GlassInputs<double>::read(MaterialParams& p) {
  read_boundary(p);
  p.color(filter, "filter", "Transmittance after one metre inside, 0 to 1 per channel.", Vec3d(1), 1);
}

namespace {

template <class T>
using GlassKernel = GlassKernelOf<Glass, T>;

}  // namespace

MaterialType glass_type() {
  return {"glass", "Smooth or rough microfacet glass: reflects, refracts and may absorb light.",
          make_material_set<Glass, GlassKernel>};
}

}  // namespace orrery
