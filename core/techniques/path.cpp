#include "core/techniques/path_tracer.h"

namespace orrery {
namespace {

// Kajiya, "The rendering equation" (SIGGRAPH 1986): full light transport, along paths that follow all lobes.
template <class T>
class Path final : public PathTracer<T> {
 public:
  Path(const World<T>& world, const Plan& plan) : PathTracer<T>(world, plan, Lobes::all) {}
};

}  // namespace

// The default depth is eight bounces plus the ray to a light source. The Cornell box is 0.4 % too dark at
// this depth.
TechniqueType path_type() {
  return {.name = "path",
          .summary = "Path tracing: global illumination along random paths (Kajiya 1986).",
          .origin = "Kajiya 1986",
          .max_depth = 9,
          .secondary_rays = true,
          .draws_light = true,
          .interreflects = true,
          .make_float = make_tracer_of<Path, float>,
          .make_double = make_tracer_of<Path, double>};
}

}  // namespace orrery
