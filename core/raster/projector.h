#pragma once

#include "core/raster/screen.h"

namespace orrery {

// Range of the sample positions of a pixel, in subpixels from its left or upper edge.
struct SampleRange {
  int lo, hi;
};

// Projection of triangles to the image of a plan. The plan must outlive this object.
class Projector {
 public:
  Projector(const Plan& plan, const SampleRange& samples);

  // Projects from[begin] to from[end - 1] to to[begin] to to[end - 1].
  void project(const Strided<Vec3d>& from, std::size_t begin, std::size_t end, ScreenVertex* to) const;
  // Calls add(triangle, corners) for the parts of a triangle inside the region to which triangles are
  // clipped.
  template <class Add>
  void clip(const std::array<Vec3d, 3>& positions, const Add& add) const {
    const Polygon polygon = clipped(positions);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      ScreenTriangle triangle;
      const std::array<const ClippedCorner*, 3> corners{&polygon[0], &polygon[i - 1], &polygon[i]};
      if (place(corners, triangle))
        add(triangle, Screen::Corners{corners[0]->weights, corners[1]->weights, corners[2]->weights});
    }
  }

 private:
  // Corner of a clipped polygon in camera coordinates: to the right, up and ahead, in metres; and the weights
  // of the corners of its triangle.
  struct ClippedCorner {
    Vec3d at, weights;
  };
  using Polygon = std::vector<ClippedCorner>;

  // The vertices as lanes, or as a scalar.
  template <class N>
  void project(const Vec3<N>& position, ScreenVertex* to) const;
  template <class N>
  Vec3<N> in_camera(const Vec3<N>& position) const;
  template <class N>
  N beyond_guard(const Vec3<N>& at, int side) const;
  template <class N>
  void place(const Vec3<N>& at, N& x, N& y) const;
  template <class N>
  N nearness(const Vec3<N>& at) const {
    return parallel_ ? N(-at.z) : N(1 / at.z);
  }
  // Returns false if the triangle touches the eye.
  bool place(const std::array<const ClippedCorner*, 3>& corners, ScreenTriangle& triangle) const;
  bool outside_image(const Polygon& triangle) const;
  Polygon clipped(const std::array<Vec3d, 3>& positions) const;
  Polygon clipped(const Polygon& polygon, int side) const;

  const CameraFrame& frame_;
  bool parallel_;
  int width_, height_;
  double scale_;  // pixels per metre, at depth 1 m unless parallel
  double reach_;  // largest distance of samples from the image, pixels
};

}  // namespace orrery
