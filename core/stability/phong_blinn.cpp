#include <algorithm>
#include <cmath>

#include "core/materials/rough.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

constexpr double kShininess = 50, kFactor = 4.02;

// Returns the unit vector at the angle `from_normal` from +z and at the azimuth `about`, both in degrees.
Vec3d direction_at(double from_normal, double about) {
  const auto theta = sine_cosine_turns(from_normal / 360), phi = sine_cosine_turns(about / 360);
  return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
}

double highlight_of(const Rough<double>& rough, const Vec3d& light, const Vec3d& viewer) {
  const Vec3d normal(0, 0, 1);
  return pow_unit(rough.highlight(normal, light, viewer, half_vector(light, viewer), light.z),
                  rough.shininess);
}

// Returns (R.V)^50 by repeated squaring, with the mirrored light direction R (Phong 1975).
double phong(const Vec3d& light, const Vec3d& viewer) {
  const Vec3d mirrored(-light.x, -light.y, light.z);
  const double c = std::max(0.0, dot(mirrored, viewer)), c2 = c * c, c8 = c2 * c2 * c2 * c2, c16 = c8 * c8;
  return c16 * c16 * c16 * c2;
}

// Returns the largest differences over viewers whose azimuth is within `about_most` degrees of the azimuth of
// the mirrored light. If `about_most` is 0, uses the plane of incidence, on both sides of the normal.
StabilityFigures differ_at(double light_degrees, double about_most) {
  Rough<double> blinn{}, rough{};
  blinn.shininess = kFactor * kShininess;
  rough.shininess = kShininess;
  rough.phong = 1;
  const Vec3d light = direction_at(light_degrees, 0);
  StabilityFigures largest{0, 0};
  for (double about = 0; about <= about_most; about += 2)
    for (double from_normal = about_most > 0 ? 0 : -89.5; from_normal < 90; from_normal += 0.5) {
      const Vec3d viewer = direction_at(from_normal, 180 - about);
      const double exact = phong(light, viewer);
      largest.known = std::max(largest.known, std::abs(highlight_of(blinn, light, viewer) - exact));
      largest.ours = std::max(largest.ours, std::abs(highlight_of(rough, light, viewer) - exact));
    }
  return largest;
}

StabilityFigures measure() {
  LineChart chart{"phong-blinn",
                  "Blinn highlight with 4.02 n instead of Phong with n = 50",
                  "angle between light and normal, degrees",
                  "largest difference; highlights reach 1",
                  false,
                  true,
                  {{"any viewer", {}}, {"viewer in incidence plane", {}}}};
  StabilityFigures figures{0, 0};
  for (double light = 0; light < 90; light += 4) {
    const StabilityFigures all = differ_at(light, 180), in_plane = differ_at(light, 0);
    chart.series[0].points.push_back({light, all.known});
    chart.series[1].points.push_back({light, in_plane.known});
    figures.known = std::max(figures.known, all.known);
    figures.ours = std::max(figures.ours, all.ours);
  }
  figures.chart = std::move(chart);
  return figures;
}

}  // namespace

StabilityRow phong_blinn_row() {
  return {"B7",
          "Phong and Blinn",
          "Phong highlight with exponent 50, for any light and viewer: largest error",
          "radiance",
          "Blinn highlight with 4.02 times the exponent, which fits in the plane of incidence",
          0.9,
          "highlight model that the material selects",
          1e-12,
          measure};
}

}  // namespace orrery
