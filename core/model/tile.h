#pragma once

#include "core/model/batch.h"

namespace orrery {

// Side of the square of pixels that one batch of camera rays covers. Tiles form a fixed grid anchored at
// pixel (0, 0) of the image.
inline constexpr int kTileSide = 32;
static_assert(kTileSide * kTileSide == kBatch);

// Pixel within a tile. tile_pixel(slot) returns the pixel of element `slot` of the batch. Elements are in
// blocks of 4x4 pixels, so that the rays of one register are neighbours at any SIMD width.
struct TilePixel {
  int x, y;
};
constexpr TilePixel tile_pixel(int slot) {
  const int block = slot / 16, within = slot % 16;
  constexpr int kBlocks = kTileSide / 4;
  return {block % kBlocks * 4 + within % 4, block / kBlocks * 4 + within / 4};
}

// Tile of an image, and a range of its samples. Row 0 is at the top.
struct TileView {
  int x0, y0;               // first pixel, in the image; multiples of kTileSide
  int width, height;        // size of the part inside the image, 1 to kTileSide pixels
  std::uint64_t frame = 0;  // animation frame; each frame has different random numbers
  int first_sample = 0, samples = 1;

  // Returns true if the whole tile is inside the image.
  bool is_whole() const { return width == kTileSide && height == kTileSide; }
};

// Calls visit(slot) for the batch element of each pixel of the tile that is inside the image.
template <class Visit>
void for_each_slot(const TileView& tile, const Visit& visit) {
  for (int slot = 0; slot < kBatch; ++slot) {
    const TilePixel p = tile_pixel(slot);
    if (tile.is_whole() || (p.x < tile.width && p.y < tile.height)) visit(static_cast<std::size_t>(slot));
  }
}

// Tiles of an image, row by row.
class TileGrid {
 public:
  TileGrid(int width, int height)
      : width_(width),
        height_(height),
        across_((width + kTileSide - 1) / kTileSide),
        down_((height + kTileSide - 1) / kTileSide) {}

  int size() const { return across_ * down_; }
  // Returns tile `index` with samples 0 to `samples` - 1. REQUIRES: 0 <= index < size().
  TileView at(int index, int samples) const {
    const int x0 = index % across_ * kTileSide, y0 = index / across_ * kTileSide;
    return {.x0 = x0,
            .y0 = y0,
            .width = std::min(kTileSide, width_ - x0),
            .height = std::min(kTileSide, height_ - y0),
            .samples = samples};
  }

 private:
  int width_, height_, across_, down_;
};

}  // namespace orrery
