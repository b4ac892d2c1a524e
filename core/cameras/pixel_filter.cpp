#include "core/cameras/pixel_filter.h"

#include <algorithm>
#include <numbers>

#include "core/math/angles.h"
#include "core/math/elementary.h"

namespace orrery {
namespace {

double usual_width(Filter filter) {
  switch (filter) {
    case Filter::box: return 1;
    case Filter::gaussian:
    case Filter::blackman_harris: return 3;
    case Filter::mitchell: return 4;
    case Filter::lanczos: return 6;
  }
  return 1;
}

// Computes sin(pi x) / (pi x).
double sinc(double x) { return x == 0 ? 1 : sine_cosine_degrees(180 * x).sine / (std::numbers::pi * x); }

// Evaluates the filter of Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (SIGGRAPH
// 1988), B = C = 1/3, for x in [0, 2].
double mitchell(double x) {
  constexpr double b = 1.0 / 3, c = 1.0 / 3;
  if (x < 1) return (((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + (6 - 2 * b)) / 6;
  return ((((-b - 6 * c) * x + (6 * b + 30 * c)) * x + (-12 * b - 48 * c)) * x + (8 * b + 24 * c)) / 6;
}

// Evaluates the filter at a distance from its centre. `share` is the distance divided by the half width.
double height(Filter filter, double share) {
  switch (filter) {
    case Filter::box: return 1;
    case Filter::gaussian: return exp2_flushed(-4.5 * share * share * std::numbers::log2e);
    case Filter::blackman_harris: {  // Harris 1978: four terms, side lobes 92 dB down
      const auto cosine = [&](double times) { return sine_cosine_degrees(180 * (1 + share) * times).cosine; };
      return 0.35875 - 0.48829 * cosine(1) + 0.14128 * cosine(2) - 0.01168 * cosine(3);
    }
    case Filter::mitchell: return mitchell(2 * share);
    case Filter::lanczos: return sinc(3 * share) * sinc(share);
  }
  return 1;
}

}  // namespace

void PixelFilter::Lobes::close() {
  const float all = sums.back();
  for (float& sum : sums) sum = all > 0 ? sum / all : 0;
  std::uint16_t cell = 0;
  for (int i = 0; i < kCells; ++i) {
    while (cell + 1 < kCells && sums[cell + 1u] <= static_cast<float>(i) / kCells) ++cell;
    guide[static_cast<std::size_t>(i)] = cell;
  }
}

float PixelFilter::Lobes::at(float u) const {
  std::size_t cell = guide[static_cast<std::size_t>(u * kCells)];
  while (cell + 1 < kCells && sums[cell + 1] <= u) ++cell;
  const float size = sums[cell + 1] - sums[cell];
  const float within = size > 0 ? std::min((u - sums[cell]) / size, 1.0f) : 0.5f;
  return (static_cast<float>(cell) + within) / kCells;
}

PixelFilter::PixelFilter(Filter filter, double width)
    : half_width_((width > 0 ? width : usual_width(filter)) / 2) {
  constexpr int kSteps = 8;  // quadrature steps per cell
  double above = 0, below = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    double mass = 0;
    for (int step = 0; step < kSteps; ++step) mass += height(filter, (cell + (step + 0.5) / kSteps) / kCells);
    (mass > 0 ? above : below) += std::abs(mass);
    above_.sums[static_cast<std::size_t>(cell) + 1] = static_cast<float>(above);
    below_.sums[static_cast<std::size_t>(cell) + 1] = static_cast<float>(below);
  }
  above_.mass = above / (above - below);
  below_.mass = below / (above - below);
  above_.close();
  below_.close();
  positive_ = above_.mass * above_.mass + below_.mass * below_.mass;
  negative_ = 2 * above_.mass * below_.mass;
}

// Returns the coordinate of a sample relative to the pixel's corner, in pixels, for a uniform u in [0, 1).
float PixelFilter::offset(const Lobes& lobes, float u) const {
  const float signed_share = 2 * u - 1;
  const float share = lobes.at(std::min(std::abs(signed_share), 1 - 0x1p-24f));
  return 0.5f + std::copysign(share, signed_share) * static_cast<float>(half_width_);
}

// In the positive part, the lobes of x and y have the same sign. In the negative part, they have different
// signs. Each part has two cases, distinguished by the sign of the lobe of x. u selects the case and is
// rescaled to [0, 1).
void PixelFilter::place(Part part, TileSamples& samples) const {
  const bool alike = part == Part::positive;
  const float first =
      alike ? static_cast<float>(above_.mass * above_.mass / positive_) : 0.5f;  // P(x in above_)
  for (int slot = 0; slot < kBatch; ++slot) {
    const float u = samples.u[slot], v = samples.v[slot];
    const bool x_above = u < first, y_above = x_above == alike;
    const float left = x_above ? u / first : (u - first) / (1 - first);
    samples.u[slot] = offset(x_above ? above_ : below_, left);
    samples.v[slot] = offset(y_above ? above_ : below_, v);
  }
}

}  // namespace orrery
