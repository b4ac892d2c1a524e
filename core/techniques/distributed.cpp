#include "core/techniques/path_tracer.h"

namespace orrery {
namespace {

// Cook, Porter, Carpenter, "Distributed Ray Tracing" (SIGGRAPH 1984): samples are distributed over lights,
// lens, time and the directions of gloss and translucency. Each sample follows one path instead of a tree.
// Paths end at diffuse surfaces.
template <class T>
class Distributed final : public PathTracer<T> {
 public:
  Distributed(const World<T>& world, const Plan& plan) : PathTracer<T>(world, plan, Lobes::non_diffuse) {}
};

}  // namespace

// The default depth is the default of `whitted` plus 1, because along a path, the ray to a light source
// counts as one more level.
TechniqueType distributed_type() {
  return {
      .name = "distributed",
      .summary = "Distributed ray tracing: soft shadows, gloss, translucency, lens, motion blur (Cook 1984).",
      .origin = "Cook 1984",
      .max_depth = 6,
      .secondary_rays = true,
      .draws_light = true,
      .not_followed = {"interreflection", "caustics"},
      .make_float = make_tracer_of<Distributed, float>,
      .make_double = make_tracer_of<Distributed, double>};
}

}  // namespace orrery
