#include "core/techniques/scan_line.h"

namespace orrery {
namespace {

template <class T>
class Flat final : public ScanLine<T> {
 public:
  Flat(const World<T>& world, const Plan& plan) : ScanLine<T>(world, plan, ShadingPoints::triangles) {}
};

}  // namespace

TechniqueType flat_type() {
  return {.name = "flat",
          .summary = "Scan line: one colour per triangle, without shadows.",
          .origin = "Bouknight 1970",
          .max_depth = 5,
          .rasterizes = true,
          .not_followed = {"shadows", "reflections", "refractions", "interreflection", "caustics"},
          .make_float = make_tracer_of<Flat, float>,
          .make_double = make_tracer_of<Flat, double>};
}

}  // namespace orrery
