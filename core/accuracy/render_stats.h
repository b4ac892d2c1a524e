#pragma once

#include "core/accuracy/film_error.h"
#include "core/model/accelerator.h"
#include "core/model/counts.h"

namespace orrery {

// Cost of a render and error statistics of its film.
struct RenderStats : FilmError {
  TraceCounts counts;
  const AcceleratorType* accelerator = nullptr;
  AcceleratorFacts structure;  // acceleration structure that traced the rays
  double build_ms = 0;         // wall-clock time to settle the plan and prepare the scene; 0 if cached
  double trace_ms = 0;         // wall-clock time of tracing
  double cpu_ms = 0;           // CPU time of tracing, summed over all threads
};

}  // namespace orrery
