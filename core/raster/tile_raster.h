#pragma once

#include "core/model/batch.h"
#include "core/model/tile.h"
#include "core/raster/facets.h"

namespace orrery {

// Z-buffer of one tile. Not thread-safe: each thread needs a separate object.
class TileRaster {
 public:
  // `screen` must outlive this object. `perspective`: weights are linear in the scene, not in the image.
  TileRaster(const Screen& screen, bool perspective) : screen_(screen), perspective_(perspective) {}

  // Finds the nearest triangle at each sample of the tile. At equal depths, the first triangle wins. A sample
  // on an edge belongs to the triangle that is below or to the right of the edge (top-left rule), so exactly
  // one of the triangles that share an edge covers the sample.
  void draw(const TileView& tile, const TileSamples& samples);
  // Finds the next triangle behind the known one at each sample for which `wanted` is true (depth peeling;
  // Everitt, "Interactive Order-Independent Transparency", 2001). All other samples become uncovered. At
  // equal depths, the triangles follow in their order. REQUIRES: draw() was called, and wanted samples are
  // covered.
  void peel(const std::array<bool, kBatch>& wanted);

  bool covered(int slot) const { return nearest_[slot] >= 0; }
  // Returns the number of the triangle at a sample: see Screen::Block. REQUIRES: covered(slot).
  std::uint32_t triangle(int slot) const { return number(slot) / Screen::kParts; }
  // Returns the weights of the corners of triangle(slot) at samples, whose sum is 1 up to rounding. REQUIRES:
  // the samples are covered.
  Facets::Weights weights(const std::array<int, Facets::kLanes>& slots) const;

 private:
  using N = Lanes<double>;
  // Triangle prepared for the tile: edge i is opposite to corner i. Its function a x + b y + c is 0 on the
  // edge and positive inside. All numbers are integers.
  struct Edges {
    std::array<double, 3> a, b, c;
    std::array<double, 3> least;  // 0 if samples on the edge are inside, else 1
    double area;                  // twice the area: the sum of the edge functions
  };
  Edges edges_of(const ScreenTriangle& triangle) const;
  // Draws all triangles of the tile. `peels`: only those behind the limits.
  template <bool peels>
  void draw_triangles();
  template <bool peels>
  void draw(const ScreenTriangle& triangle, Screen::Number number);
  template <bool peels>
  void draw(const Screen::Fragment& fragment);
  Screen::Number number(int slot) const { return static_cast<Screen::Number>(nearest_[slot]); }

  const Screen& screen_;
  const bool perspective_;
  TileView tile_{};
  Array<double> x_, y_;  // samples, in subpixels from the corner of the tile
  double reach_ = 0;     // largest distance of a sample from the centre of its pixel, subpixels
  Array<double> nearness_;
  Array<std::int64_t> nearest_;  // Screen::Number, or -1
  // While peeling: nearness_ and nearest_ of the previous layer, or -infinity for samples that are not
  // wanted.
  Array<double> limit_;
  Array<std::int64_t> limit_number_;
};

}  // namespace orrery
