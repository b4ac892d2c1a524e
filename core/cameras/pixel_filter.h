#pragma once

#include <array>

#include "core/model/camera.h"
#include "core/model/render_settings.h"

namespace orrery {

// Pixel filter by importance sampling: the sample density follows the filter, so each sample belongs to one
// pixel and all weights are equal (Ernst, Stamminger, Greiner, "Filter Importance Sampling", RT 2006). A
// filter f(x) f(y) with negative lobes is the difference of two positive parts. Each part has its own
// samples, so constant images stay constant. The filter is tabulated in kCells steps from centre to edge.
class PixelFilter {
 public:
  // `width` is in pixels, from edge to edge. 0 selects the default: box 1, gaussian 3 (six standard
  // deviations), blackman-harris 3 (four terms), mitchell 4 (B = C = 1/3), lanczos 6 (three lobes).
  PixelFilter(Filter filter, double width);

  // Weights of the two parts. The value of a pixel is positive() times the mean of its positive samples minus
  // negative() times the mean of its negative samples. positive() - negative() is 1.
  double positive() const { return positive_; }
  double negative() const { return negative_; }  // 0 if the filter has no negative lobes

  float half_width() const { return static_cast<float>(half_width_); }  // pixels

  // Warps uniform samples in [0, 1) to the distribution of a part.
  enum class Part { positive, negative };
  void place(Part part, TileSamples& samples) const;

 private:
  static constexpr int kCells = 512;
  // Positive or negative lobes of f on one side of its centre.
  struct Lobes {
    double mass = 0;                            // integral over both sides
    std::array<float, kCells + 1> sums{};       // CDF at the cell borders, from 0 to 1
    std::array<std::uint16_t, kCells> guide{};  // guide[i]: first cell that ends above i / kCells
    void close();
    // Returns the distance from the centre, as a fraction of the half width, for a uniform u in [0, 1).
    float at(float u) const;
  };
  float offset(const Lobes& lobes, float u) const;

  double half_width_;
  Lobes above_, below_;
  double positive_ = 1, negative_ = 0;
};

inline bool has_negative_lobes(Filter filter) {
  return filter == Filter::mitchell || filter == Filter::lanczos;
}

// Returns whether samples need warping. False for a box filter of one pixel, whose samples stay uniform.
inline bool warps_samples(Filter filter, double width) {
  return filter != Filter::box || (width != 0 && width != 1);
}

}  // namespace orrery
