#pragma once

#include <cstdint>

#include "core/render/clamped.h"
#include "core/render/halves.h"
#include "core/render/sampled_error.h"

namespace orrery {

// What a film tells of its own error.
struct FilmError {
  std::uint64_t non_finite_pixels = 0;
  Omitted omitted;
  Clamped clamped;
  Halves halves;       // over Plan::halves_range(); empty if nothing limits samples
  SampledError error;  // of an even number of samples, of which at least the second half was traced together

  // Other tiles.
  void add(const FilmError& other) {
    non_finite_pixels += other.non_finite_pixels;
    omitted.add(other.omitted);
    clamped.add(other.clamped);
    halves.add(other.halves);
    error.add(other.error);
  }
  // What was told before the last pass, after which the film itself tells of all samples.
  void join(const FilmError& before) {
    omitted.join(before.omitted);
    clamped.join(before.clamped);
  }
};

}  // namespace orrery
