#include "core/materials/subsurface.h"

#include <algorithm>
#include <numbers>

#include "core/materials/glass_kernel.h"
#include "core/params/params.h"

namespace orrery {

template <>
void SubsurfaceInputs<double>::read(MaterialParams& p) {
  constexpr double kMaxAnisotropy = 0.99;
  filter = Vec3d(1);
  read_boundary(p);
  albedo = p.plain().coefficient(
      "albedo", "Fraction of light that each scattering event keeps, 0 to 1 per channel.", {}, 1);
  const Vec3d path = p.plain().coefficient(
      "mean_free_path", "Mean distance between two events, at least 1e-12 m, per channel.", {}, kMaxLength);
  anisotropy = p.plain().number("anisotropy",
                                "Mean cosine of the scattering angle (Henyey-Greenstein): 0 in all "
                                "directions alike, > 0 mostly forward, < 0 mostly backward.",
                                {.min = -kMaxAnisotropy, .max = kMaxAnisotropy}, 0.0);
  const double least = std::min({path.x, path.y, path.z});
  if (least < kMinLength)
    p.plain().fail("mean_free_path", "must be at least " + number_text(kMinLength) +
                                         " in every channel (got " + number_text(least) + ")");
  const auto rate = [](double metres) { return -1 / (metres * std::numbers::ln2); };
  log2_transmittance = {rate(path.x), rate(path.y), rate(path.z)};
}

namespace {

template <class T>
using SubsurfaceKernel = GlassKernelOf<Subsurface, T>;

}  // namespace

MaterialType subsurface_type() {
  return {"subsurface", "Smooth or rough surface around a medium that scatters light: wax, marble, fog.",
          make_material_set<Subsurface, SubsurfaceKernel>};
}

}  // namespace orrery
