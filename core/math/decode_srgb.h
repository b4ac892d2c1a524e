#pragma once

#include <cmath>

namespace orrery {

// Decodes an sRGB code / 255 to linear (IEC 61966-2-1), both in [0, 1].
inline float decode_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace orrery
