#include "core/textures/noise_params.h"
#include "core/textures/texture_of.h"
#include "core/textures/waves.h"

namespace orrery {
namespace {

// Annual rings around the y axis, bent by noise: the share of `late` wood is (1 - cos 2 pi (r + distortion *
// noise)) / 2, where r is the distance from the axis.
template <class N>
struct Wood {
  Vec3<N> early, late;
  N distortion;
  NoiseSum<N> noise;

  TextureBounds bounds() const { return bounds_of_mix(early, late); }
  double detail() const { return std::min(0.25, noise.detail()); }

  Vec3<N> value(const Vec3<N>& at, const Vec3<N>& width) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N radius = sqrt(at.x * at.x + at.z * at.z);
    const N rings = radius + distortion * noise.at(at, width);
    const N share = T(0.5) - T(0.5) * mean_cosine(rings, max_first(width.x, width.z));
    return mix_colors(early, late, min_first(N(T(1)), max_first(N(T(0)), share)));
  }
};

std::shared_ptr<const Texture> read_wood(Params& p, const AssetSource&) {
  Wood<double> wood;
  wood.early =
      p.coefficient("early", "Value of early wood, between the dark rings.", Vec3d(0.72, 0.47, 0.24));
  wood.late = p.coefficient("late", "Value of late wood, the dark rings.", Vec3d(0.36, 0.19, 0.08));
  wood.distortion = p.number("distortion", "Largest shift of the rings, in distances between rings.",
                             {.min = 0, .max = 100}, 0.4);
  wood.noise = read_noise_sum(p, 3, false);
  return std::make_shared<const TextureOf<Wood>>(wood);
}

}  // namespace

TextureType wood_type() {
  return {"wood", "Rings around the y axis at a distance of 1, bent by noise.", read_wood};
}

}  // namespace orrery
