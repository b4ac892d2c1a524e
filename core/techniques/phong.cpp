#include "core/techniques/scan_line.h"

namespace orrery {
namespace {

template <class T>
class Phong final : public ScanLine<T> {
 public:
  Phong(const World<T>& world, const Plan& plan) : ScanLine<T>(world, plan, ShadingPoints::pixels) {}
};

}  // namespace

TechniqueType phong_type() {
  return {.name = "phong",
          .summary =
              "Scan line: normals of vertices, interpolated and lit per pixel, without shadows (Phong 1975).",
          .origin = "Phong 1975",
          .max_depth = 5,
          .rasterizes = true,
          .not_followed = {"shadows", "reflections", "refractions", "interreflection", "caustics"},
          .make_float = make_tracer_of<Phong, float>,
          .make_double = make_tracer_of<Phong, double>};
}

}  // namespace orrery
