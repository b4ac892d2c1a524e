#include "core/textures/noise_params.h"
#include "core/textures/texture_of.h"
#include "core/textures/waves.h"

namespace orrery {
namespace {

// Layers along x, bent by turbulence (Perlin, "An Image Synthesizer", SIGGRAPH 1985): the share of `vein` is
// ((1 + cos 2 pi (x + distortion * turbulence)) / 2) ^ sharpness.
template <class N>
struct Marble {
  Vec3<N> stone, vein;
  N distortion, sharpness;
  NoiseSum<N> turbulence;

  TextureBounds bounds() const { return bounds_of_mix(stone, vein); }
  double detail() const { return std::min(0.25, turbulence.detail()); }

  Vec3<N> value(const Vec3<N>& at, const Vec3<N>& width) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const N phase = at.x + distortion * turbulence.at(at, width);
    const N wave = T(0.5) + T(0.5) * mean_cosine(phase, width.x);
    const N share = pow_unit(min_first(one, max_first(zero, wave)), sharpness);
    return mix_colors(stone, vein, min_first(one, share));
  }
};

std::shared_ptr<const Texture> read_marble(Params& p, const AssetSource&) {
  Marble<double> marble;
  marble.stone = p.coefficient("stone", "Value between the veins.", Vec3d(0.85));
  marble.vein = p.coefficient("vein", "Value of the veins.", Vec3d(0.2));
  marble.distortion = p.number("distortion", "Largest shift of the veins, in distances between veins.",
                               {.min = 0, .max = 100}, 2.0);
  marble.sharpness = p.number("sharpness", "Exponent that narrows the veins.", {.min = 1, .max = 100}, 3.0);
  marble.turbulence = read_noise_sum(p, 6, true);
  return std::make_shared<const TextureOf<Marble>>(marble);
}

}  // namespace

TextureType marble_type() {
  return {"marble", "Veins across x at a distance of 1, bent by turbulence.", read_marble};
}

}  // namespace orrery
