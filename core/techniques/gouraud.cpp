#include "core/techniques/scan_line.h"

namespace orrery {
namespace {

template <class T>
class Gouraud final : public ScanLine<T> {
 public:
  Gouraud(const World<T>& world, const Plan& plan) : ScanLine<T>(world, plan, ShadingPoints::vertices) {}
};

}  // namespace

TechniqueType gouraud_type() {
  return {.name = "gouraud",
          .summary = "Scan line: colours of vertices, interpolated, without shadows (Gouraud 1971).",
          .origin = "Gouraud 1971",
          .max_depth = 5,
          .rasterizes = true,
          .not_followed = {"shadows", "reflections", "refractions", "interreflection", "caustics"},
          .make_float = make_tracer_of<Gouraud, float>,
          .make_double = make_tracer_of<Gouraud, double>};
}

}  // namespace orrery
