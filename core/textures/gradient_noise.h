#pragma once

#include <cstdint>

#include "core/math/lanes.h"
#include "core/math/vec3.h"

namespace orrery {

// Gradient noise of Perlin ("Improving Noise", SIGGRAPH 2002): at each lattice point one of 12 gradients, the
// directions to the middles of the edges of a cube, blended by 6 t^5 - 15 t^4 + 10 t^3. The noise is 0 at
// lattice points, has two continuous derivatives and the period 256 along each axis. An integer hash selects
// the gradients instead of the paper's table, so that lanes need no gathers. Four of the 16 values of the
// hash repeat gradients, as in the paper. Scalars and lanes, and float and double, use the same gradients.
template <class N>
class GradientNoise {
 public:
  using T = ScalarOf<N>;

  // `seed` selects one of 2^24 patterns.
  explicit GradientNoise(const N& seed) : seed_(convert_to<Integer>(seed)) {}

  // Largest absolute value, at cell centres for the least favourable gradients: measured, see the tests.
  static constexpr double kMax = 1.0366;

  [[gnu::always_inline]] N at(const Vec3<N>& p) const {
    const Axis x(p.x), y(p.y), z(p.z);
    const auto corner = [&](int i, int j, int k) {
      return along_gradient(hash(x, i, y, j, z, k), x.from[i], y.from[j], z.from[k]);
    };
    const auto mix = [](const N& a, const N& b, const N& share) -> N { return a + (b - a) * share; };
    const auto edge = [&](int j, int k) { return mix(corner(0, j, k), corner(1, j, k), x.fade); };
    const auto face = [&](int k) { return mix(edge(0, k), edge(1, k), y.fade); };
    return mix(face(0), face(1), z.fade);
  }

 private:
  template <class M>
  struct UnsignedOf {
    using type = std::conditional_t<sizeof(M) == 4, std::uint32_t, std::uint64_t>;
  };
  template <class M, class Abi>
  struct UnsignedOf<stdx::simd<M, Abi>> {
    using type = stdx::rebind_simd_t<typename UnsignedOf<M>::type, stdx::simd<M, Abi>>;
  };
  using Integer = typename UnsignedOf<N>::type;

  // One coordinate: the cell modulo 256 and the next one, the distances from both ends, and the blend.
  struct Axis {
    Integer cell[2];
    N from[2];
    N fade;

    [[gnu::always_inline]] explicit Axis(const N& x) {
      using std::floor;
      const N whole = floor(x), t = x - whole;
      const N wrapped = whole - T(256) * floor(whole * T(1.0 / 256));
      cell[0] = convert_to<Integer>(wrapped);
      cell[1] = (cell[0] + Integer(1)) & Integer(255);
      from[0] = t;
      from[1] = t - T(1);
      fade = t * t * t * (t * (t * T(6) - T(15)) + T(10));
    }
  };

  // Mixes the low 32 bits (finaliser of MurmurHash3 by Appleby, with one multiplication less). 64-bit lanes
  // are masked, so that all number types return the same hash.
  [[gnu::always_inline]] Integer hash(const Axis& x, int i, const Axis& y, int j, const Axis& z,
                                      int k) const {
    const auto low = [](const Integer& v) -> Integer { return v & Integer(0xffffffffu); };
    Integer h = x.cell[i] | (y.cell[j] << 8) | (z.cell[k] << 16);
    h = low((h + seed_ * Integer(0x9e3779b1u)) * Integer(0x85ebca6bu));
    h = h ^ (h >> 13);
    h = low(h * Integer(0xc2b2ae35u));
    return (h ^ (h >> 16)) >> 12;
  }

  // Returns the product of the gradient, selected by the low 4 bits of `h`, and (x, y, z).
  [[gnu::always_inline]] static N along_gradient(const Integer& h, const N& x, const N& y, const N& z) {
    const auto bit = [&h](unsigned mask) { return mask_cast_to<N>((h & Integer(mask)) != Integer(0)); };
    const auto b8 = bit(8), b4 = bit(4);
    const auto twelve_or_fourteen = mask_cast_to<N>((h & Integer(13)) == Integer(12));
    const N u = select(b8, y, x);
    const N v = select(b8, select(twelve_or_fourteen, x, z), select(b4, z, y));
    return select(bit(1), N(-u), u) + select(bit(2), N(-v), v);
  }

  Integer seed_;
};

// Sum of octaves of gradient noise: octave k has the frequency 2^k and the weight gain^k. `absolute` sums
// absolute values (the turbulence of Perlin, "An Image Synthesizer", SIGGRAPH 1985). The sum is divided by
// the sum of the weights.
template <class N>
struct NoiseSum {
  N octaves, gain, absolute, seed;

  // Smallest details, in coordinates.
  double detail() const { return std::ldexp(1.0, 1 - static_cast<int>(octaves)); }

  // Returns the sum at `p`, in [-kMax, kMax], or in [0, kMax] if `absolute`. Octaves fade from their value to
  // their mean as the largest side of the box grows from half a cell to a whole cell (frequency clamping:
  // Norton, Rockwood, Skolmoski, SIGGRAPH 1982).
  N at(const Vec3<N>& p, const Vec3<N>& width) const {
    using T = ScalarOf<N>;
    using std::abs;
    const N zero(T(0)), one(T(1)), widest = max_component(width);
    const auto sums_absolute = absolute > zero;
    const int count = static_cast<int>(first_lane(octaves));
    N sum(zero), weights(zero), weight(one), frequency(one);
    for (int k = 0; k < count; ++k) {
      const N kept = min_first(one, max_first(zero, N(T(2) - T(2) * widest * frequency)));
      N octave(zero);
      if (any(kept > zero)) octave = GradientNoise<N>(seed + N(T(k))).at(p * frequency);
      const N mean = select(sums_absolute, N(T(kMeanAbsolute)), zero);
      octave = select(sums_absolute, N(abs(octave)), octave);
      sum = sum + weight * (mean + (octave - mean) * kept);
      weights = weights + weight;
      weight = weight * gain;
      frequency = frequency * T(2);
    }
    return sum / weights;
  }

  // Mean of the absolute value of GradientNoise: measured, see the tests.
  static constexpr double kMeanAbsolute = 0.2205;

 private:
  static ScalarOf<N> first_lane(const N& x) {
    if constexpr (std::is_arithmetic_v<N>)
      return x;
    else
      return x[0];
  }
};

}  // namespace orrery
