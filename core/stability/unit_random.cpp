#include "core/math/sampling.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

StabilityFigures measure() {
  StabilityFigures ones{0, 0};
  for (std::uint32_t below = 0; below < 256; ++below) {
    const std::uint32_t bits = 0xffffffffu - below;
    ones.known += static_cast<float>(bits) * 0x1p-32f >= 1;
    ones.ours += unit_float(bits) >= 1;
  }
  return ones;
}

}  // namespace

StabilityRow unit_random_row() {
  return {"A33",
          "Random numbers below 1",
          "the 256 largest 32-bit integers, converted to floats in [0, 1): results equal to 1",
          "of 256",
          "float(bits) / 2^32",
          128,
          "upper 24 bits",
          0,
          measure};
}

}  // namespace orrery
