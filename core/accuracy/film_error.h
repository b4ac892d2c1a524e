#pragma once

#include <cstdint>

#include "core/accuracy/clamp_ledger.h"
#include "core/accuracy/halves.h"
#include "core/accuracy/sampled_error.h"

namespace orrery {

// Error statistics of a film.
struct FilmError {
  std::uint64_t non_finite_pixels = 0;
  OmissionLedger omitted;  // light of untraced rays
  ClampLedger clamped;
  Halves halves;       // relative to Plan::halves_range(); empty if this range is infinite
  SampledError error;  // known if the sample count is even and the last pass traced at least the second half

  // Adds the statistics of other tiles.
  void add(const FilmError& other) {
    non_finite_pixels += other.non_finite_pixels;
    omitted.add(other.omitted);
    clamped.add(other.clamped);
    halves.add(other.halves);
    error.add(other.error);
  }
  // Adds the ledgers of earlier passes to the statistics of the last pass. The other members already cover
  // all samples.
  void join(const FilmError& before) {
    omitted.join(before.omitted);
    clamped.join(before.clamped);
  }
};

}  // namespace orrery
