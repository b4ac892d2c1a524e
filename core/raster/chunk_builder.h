#pragma once

#include "core/raster/projector.h"

namespace orrery {

// Elements of tiles, in ascending order of numbers.
template <class X>
struct Unsorted {
  std::vector<X> elements;
  std::vector<std::uint32_t> tiles;

  void add(std::uint32_t tile, const X& element) {
    elements.push_back(element);
    tiles.push_back(tile);
  }
  // Counting sort. The order of equal tiles remains.
  ByTile<X> sorted() const;
};

// Finds the tiles and the samples that the triangles of a chunk cover. Not thread-safe. `screen` has all its
// vertices, and must outlive this object.
class ChunkBuilder {
 public:
  ChunkBuilder(const Screen& screen, const Projector& projector, const Plan& plan,
               const SampleRange& samples);

  // Sets the lists of a chunk, which contains the triangles `begin` to `end` - 1.
  void build(std::uint32_t begin, std::uint32_t end, Screen::Chunk& chunk);

 private:
  using I = IndexLanes<float>;
  static constexpr int kLanes = kWidth<float>;
  // Triangles whose boxes have at most this many pixels per side are stored as fragments.
  static constexpr int kSmall = 4;

  // Pixels from lo to hi.
  template <class N>
  struct Span {
    N lo, hi;
  };
  // Triangles in lanes. All edge functions of small triangles fit in 32 bits.
  struct Lane {
    const std::array<std::uint32_t, 3>* corners[kLanes];
    std::array<I, 3> x, y;
    Span<I> across, down;  // inside the image
  };

  // Returns the pixels whose samples may be between three coordinates in subpixels.
  template <class N>
  Span<N> pixels(const std::array<N, 3>& at) const;
  // Adds triangles `first` to `first` + kLanes - 1 as far as they are below `end`.
  void add_lanes(std::uint32_t first, std::uint32_t end, Screen::Chunk& chunk);
  void add_fragments(std::uint32_t first, const Lane& lane, const I::mask_type& small);
  // Adds a triangle of any size.
  void add(std::uint32_t triangle, Screen::Chunk& chunk);
  void add_to_tiles(const ScreenTriangle& triangle, Screen::Number number);

  const Screen& screen_;
  const Projector& projector_;
  const int width_, height_;
  const SampleRange samples_;
  const Screen::Block* block_ = nullptr;
  const ScreenVertex* vertices_ = nullptr;  // vertices of the block
  Unsorted<Screen::Number> triangles_;
  Unsorted<Screen::Fragment> fragments_;
};

}  // namespace orrery
