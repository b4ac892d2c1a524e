#include <algorithm>
#include <cmath>
#include <string>

#include "core/load/load.h"
#include "core/math/elementary.h"
#include "core/stability/pictures.h"
#include "core/stability/row.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

constexpr int kSide = 128, kSectors = 16, kRings = 8;
constexpr double kHalfHeight = 1.1;  // half of the image height, metres

// Returns a ball mesh of radius 1 with or without vertex normals.
std::string ball(bool smooth) {
  std::string vertices, indices;
  const auto append = [](std::string& list, const std::string& entry) {
    list += (list.empty() ? "" : ", ") + entry;
  };
  for (int ring = 0; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const auto theta = sine_cosine_turns(0.5 * ring / kRings),
                 phi = sine_cosine_turns(1.0 * sector / kSectors);
      append(vertices,
             printed("[%.17g, %.17g, %.17g]", theta.sine * phi.cosine, theta.cosine, -theta.sine * phi.sine));
      if (ring == kRings) continue;
      const int a = ring * kSectors + sector, b = ring * kSectors + (sector + 1) % kSectors;
      if (ring > 0) append(indices, printed("[%d, %d, %d]", a, a + kSectors, b));
      if (ring + 1 < kRings) append(indices, printed("[%d, %d, %d]", b, a + kSectors, b + kSectors));
    }
  return R"({"type": "mesh", "material": "m", "positions": [)" + vertices +
         (smooth ? R"(], "normals": [)" + vertices : std::string()) + R"(], "indices": [)" + indices + "]}";
}

// Renders an object. The terminator of a ball runs along the middle of facets.
std::vector<float> picture_of(const std::string& object) {
  RenderRequest request;
  request.width = request.height = kSide;
  request.precision = Precision::double_precision;
  const auto scene = load_scene(
      R"({"version": 1, "ambient": [0, 0, 0], "materials": {"m": {"type": "lambert", "reflectance": [1, 1, 1]}},
          "lights": [{"type": "directional", "direction_to_light": [1, 0, 0.19]}],
          "camera": {"type": "orthographic", "eye": [0, 0, 4], "look_at": [0, 0, 0], "height": )" +
      printed("%.17g", 2 * kHalfHeight) + R"(}, "objects": [)" + object + "]}");
  return values_of(rendered(scene, request).film);
}

// The ball is convex, so the known method shades a pixel unless the flat ball is dark there. Compares pixels
// whose points are nearer than 0.7 to the view axis: near the silhouette, the points of a ball and of a mesh
// differ.
StabilityFigures measure() {
  const std::vector<float> flat = picture_of(ball(false)), smooth = picture_of(ball(true)),
                           sphere = picture_of(
                               R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"})");
  StabilityFigures largest{0, 0};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double scale = 2 * kHalfHeight / kSide, across = (x + 0.5) * scale - kHalfHeight,
                   up = (y + 0.5) * scale - kHalfHeight;
      if (across * across + up * up > 0.49) continue;
      const auto i = static_cast<std::size_t>(3 * (y * kSide + x));
      const double right = double{sphere[i]}, ours = double{smooth[i]};
      largest.known = std::max(largest.known, std::abs((flat[i] > 0 ? ours : 0) - right));
      largest.ours = std::max(largest.ours, std::abs(ours - right));
    }
  return largest;
}

}  // namespace

StabilityRow terminator_row() {
  return {"C11",
          "Shadow terminator",
          "ball of 16 by 8 facets with vertex normals, light that grazes the middle of facets: largest "
          "difference "
          "from the sphere",
          "radiance",
          "light behind the plane of a triangle is ignored",
          0.15,
          "light in front of the interpolated normal counts; shadow rays below the plane start at the curved "
          "surface (Hanika 2021)",
          0.02,
          measure};
}

}  // namespace orrery
