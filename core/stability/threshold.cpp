#include <cmath>

#include "core/load/load.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

constexpr double kThreshold = 1.0 / 255;

// Scene with two slabs of glass in front of a background of radiance 1. A black plane behind the camera
// absorbs reflected rays. Each of the four surfaces reflects half of the light at normal incidence. Together,
// with all interreflections, they transmit 1 / 5.
constexpr const char* kSlabs = R"({"version": 1, "background": [1, 1, 1],
  "camera": {"type": "orthographic", "eye": [0, 0, 5], "look_at": [0, 0, 0], "height": 1},
  "materials": {"glass": {"type": "refractive", "ior": 5.82842712474619, "fresnel": "exact"},
                "black": {"type": "rough", "kd": 0}},
  "objects": [{"type": "plane", "point": [0, 0, 9], "normal": [0, 0, -1], "material": "black"},
              {"type": "box", "min": [-50, -50, -1], "max": [50, 50, 0], "material": "glass"},
              {"type": "box", "min": [-50, -50, -3], "max": [50, 50, -2], "material": "glass"}]})";
constexpr double kExact = 0.2;

StabilityFigures measure() {
  RenderRequest request;
  request.width = request.height = 4;
  request.technique = "whitted";
  request.precision = Precision::double_precision;
  request.max_depth = 32;
  request.min_contribution = kThreshold;
  const RenderResult result = rendered(load_scene(kSlabs), request);
  const double error = std::abs(static_cast<double>(values_of(result.film)[0]) - kExact);
  return {error / kThreshold, error / result.stats.omitted.max()};
}

}  // namespace

StabilityRow threshold_row() {
  return {
      "E2",
      "Rays of low weight",
      "two slabs whose surfaces reflect half of the light, rays of weight below 1/255 omitted: error divided "
      "by its reported bound",
      "1",
      "bound of one ray, 1/255, reported for all omitted rays (adaptive tree depth; Hall, Greenberg "
      "1983)",
      10,
      "sum of the weights of all omitted rays",
      1,
      measure};
}

}  // namespace orrery
