#pragma once

#include "core/params/params.h"
#include "core/textures/gradient_noise.h"

namespace orrery {

// Reads the octaves of a noise. `absolute` is not read.
inline NoiseSum<double> read_noise_sum(Params& p, int octaves, bool is_absolute) {
  constexpr int kMaxOctaves = 12;
  NoiseSum<double> sum;
  sum.octaves = static_cast<double>(
      p.integer("octaves", "Number of octaves; each has twice the frequency of the one before.", 1,
                kMaxOctaves, octaves));
  sum.gain = p.number("gain", "Weight of an octave, divided by the weight of the octave before.",
                      {.min = 0, .max = 1}, 0.5);
  sum.seed = static_cast<double>(p.integer("seed", "Selects the pattern.", 0, 1'000'000, 0));
  sum.absolute = is_absolute ? 1 : 0;
  return sum;
}

}  // namespace orrery
