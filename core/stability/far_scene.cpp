#include <algorithm>
#include <cmath>

#include "core/load/load.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

// Returns a scene of two balls on a floor 2 m wide, moved by `offset` metres along each axis.
std::shared_ptr<const Scene> scene_at(double offset) {
  const auto at = [&](double x, double y, double z) {
    return printed("[%.17g, %.17g, %.17g]", offset + x, offset + y, offset + z);
  };
  return load_scene(
      R"({"version": 1, "ambient": [0.2, 0.2, 0.2], "materials": {"m": {"type": "rough"}},
          "lights": [{"type": "directional", "direction_to_light": [1, 2, 1]}],
          "camera": {"type": "perspective", "eye": )" +
      at(0, 1, 4) + R"(, "look_at": )" + at(0, 0, 0) + R"(}, "objects": [
          {"type": "sphere", "center": )" +
      at(-0.5, 0, 0) + R"(, "radius": 0.5, "material": "m"},
          {"type": "sphere", "center": )" +
      at(0.5, 0, 0) + R"(, "radius": 0.25, "material": "m"},
          {"type": "rectangle", "corner": )" +
      at(-1, -0.5, -1) + R"(, "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "material": "m"}]})");
}

std::vector<float> picture_of(double offset, Precision precision) {
  RenderRequest request;
  request.width = request.height = 48;
  request.precision = precision;
  return values_of(rendered(scene_at(offset), request).film);
}

StabilityFigures measure() {
  const std::vector<float> exact = picture_of(0, Precision::double_precision),
                           in_float = picture_of(1e6, Precision::single_precision),
                           planned = picture_of(1e6, Precision::automatic);
  StabilityFigures largest{0, 0};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    largest.known = std::max(largest.known, std::abs(double{in_float[i]} - double{exact[i]}));
    largest.ours = std::max(largest.ours, std::abs(double{planned[i]} - double{exact[i]}));
  }
  return largest;
}

}  // namespace

StabilityRow far_scene_row() {
  return {"A18",
          "Scene 1,000 km from the origin",
          "image of a scene 2 m wide, moved by 1e6 m along each axis: largest change of a pixel value",
          "radiance",
          "float, whose spacing there is 0.06 m",
          0.5,
          "number type that the plan chooses from coordinates and sizes: double",
          1e-6,
          measure};
}

}  // namespace orrery
