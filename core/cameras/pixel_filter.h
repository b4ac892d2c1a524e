#pragma once

#include <array>

#include "core/model/camera.h"
#include "core/model/render_settings.h"

namespace orrery {

// Weights of samples about a pixel's middle by importance sampling: samples are placed as dense as the filter
// is high, so that each belongs to one pixel and counts alike (Ernst, Stamminger, Greiner, "Filter Importance
// Sampling", RT 2006). A filter f(x) f(y) with negative lobes is the difference of two positive ones, of
// which each gets samples of its own: so a constant stays one. Filters are tabulated in kCells steps from the
// middle to the edge.
class PixelFilter {
 public:
  // `width` in pixels, from edge to edge; 0: what is usual: box 1, gaussian 3 (six standard deviations),
  // blackman-harris 3 (four terms), mitchell 4 (B = C = 1/3), lanczos 6 (three lobes).
  PixelFilter(Filter filter, double width);

  // What the mean over the samples of each part counts: the difference is 1.
  double positive() const { return positive_; }
  double negative() const { return negative_; }  // 0: there is no such part

  float half_width() const { return static_cast<float>(half_width_); }  // pixels

  // Moves samples that are even in [0, 1) to where those of a part lie.
  enum class Part { positive, negative };
  void place(Part part, TileSamples& samples) const;

 private:
  static constexpr int kCells = 512;
  // What of f is above 0, or below, on one side of the middle.
  struct Lobes {
    double mass = 0;                            // of both sides
    std::array<float, kCells + 1> sums{};       // of the cells, from 0 to 1
    std::array<std::uint16_t, kCells> guide{};  // first cell whose sum ends beyond that share of 1
    void close();
    // Distance from the middle as a share of the half width, for an even u in [0, 1).
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

// Whether samples are placed at all: those of a box of one pixel lie right.
inline bool moves_samples(Filter filter, double width) {
  return filter != Filter::box || (width != 0 && width != 1);
}

}  // namespace orrery
