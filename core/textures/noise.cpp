#include "core/textures/noise_params.h"
#include "core/textures/texture_of.h"

namespace orrery {
namespace {

// Mixture of two colours by noise: the share of `high` is (1 + sum) / 2, or the sum of absolute values.
template <class N>
struct Noise {
  Vec3<N> low, high;
  NoiseSum<N> sum;

  TextureBounds bounds() const { return bounds_of_mix(low, high); }
  double detail() const { return sum.detail(); }

  Vec3<N> value(const Vec3<N>& at, const Vec3<N>& width) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1)), s = sum.at(at, width);
    const N share = select(sum.absolute > zero, s, N(T(0.5) + T(0.5) * s));
    return mix_colors(low, high, min_first(one, max_first(zero, share)));
  }
};

std::shared_ptr<const Texture> read_noise(Params& p, const AssetSource&) {
  const Vec3d low = p.coefficient("low", "Value where the noise is lowest.", Vec3d(0));
  const Vec3d high = p.coefficient("high", "Value where the noise is highest.", Vec3d(1));
  const bool is_absolute =
      p.choice("sum", "Sum of octaves of signed noise, or of absolute values (turbulence).",
               {"signed", "absolute"}, "signed") == "absolute";
  return std::make_shared<const TextureOf<Noise>>(
      Noise<double>{low, high, read_noise_sum(p, 1, is_absolute)});
}

}  // namespace

TextureType noise_type() {
  return {"noise", "Gradient noise or turbulence (Perlin 2002): cells of side 1 without a visible lattice.",
          read_noise};
}

}  // namespace orrery
