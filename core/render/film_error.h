#pragma once

#include <cstdint>

#include "core/render/clamp_ledger.h"
#include "core/render/halves.h"
#include "core/render/sampled_error.h"

namespace orrery {

// Error statistics of a film.
struct FilmError {
  std::uint64_t non_finite_pixels = 0;
  OmissionLedger omitted;
  ClampLedger clamped;
  Halves halves;       // relative to Plan::halves_range(); empty if samples have no range
  SampledError error;  // even sample counts whose second half is one pass

  // Adds other tiles.
  void add(const FilmError& other) {
    non_finite_pixels += other.non_finite_pixels;
    omitted.add(other.omitted);
    clamped.add(other.clamped);
    halves.add(other.halves);
    error.add(other.error);
  }
  // Adds the ledgers of the passes before the last one. The film's other statistics cover all samples
  // already.
  void join(const FilmError& before) {
    omitted.join(before.omitted);
    clamped.join(before.clamped);
  }
};

}  // namespace orrery
