#pragma once

#include <memory>
#include <span>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/model/tessellation.h"

// Scan line rendering: tessellation of a scene, projection, and a z-buffer for each tile. Immutable objects
// may be shared by threads. Functions throw only what their comments state, and std::bad_alloc.
namespace orrery {

// Image coordinates are integers: 1 / kSubpixels pixels from the left and the upper edge of the image. All
// edge functions and areas of triangles are then exact in double precision.
inline constexpr int kSubpixels = 1024;

// Vertex in the image.
struct ScreenVertex {
  static constexpr std::int32_t kBeyond = -(1 << 30);

  std::int32_t x, y;  // subpixels; x is kBeyond outside the region to which triangles are clipped
  double nearness;    // larger is nearer: 1 / depth, or -depth for parallel cameras
};

// Triangle in the image, inside the region to which triangles are clipped.
struct ScreenTriangle {
  std::array<std::int32_t, 3> x, y;
  std::array<double, 3> nearness;
};

// Elements of tiles of TileGrid, sorted by tile.
template <class X>
struct ByTile {
  std::vector<X> elements;
  std::vector<std::uint32_t> first;  // of tile `first_tile` and the next ones: index in `elements`
  std::uint32_t first_tile = 0;

  std::span<const X> of(std::uint32_t tile) const {
    const std::size_t i = tile - first_tile;
    if (tile < first_tile || i + 1 >= first.size()) return {};
    return {elements.data() + first[i], elements.data() + first[i + 1]};
  }
};

// Triangles of a scene in one image, sorted by tile.
struct Screen {
  // Number of a part of a triangle: kParts times the index in Tessellation::triangles. Parts of a clipped
  // triangle add 1, 2, ...
  using Number = std::uint32_t;
  static constexpr Number kParts = 8;
  static constexpr std::size_t kChunk = 16'384;  // triangles of a chunk

  // Weights of the corners of a triangle at each corner of a part of it.
  using Corners = std::array<Vec3d, 3>;
  struct ClippedPart {
    Number number;
    ScreenTriangle triangle;
    Corners corners;
  };
  // Sample of a tile that a triangle covers.
  struct Fragment {
    double nearness;
    Number number;
    std::uint16_t slot;  // element of the batch of the tile
  };
  // kChunk triangles in the order of Tessellation::triangles. All lists are in ascending order of numbers,
  // within tiles if sorted by tile.
  struct Chunk {
    std::vector<ClippedPart> clipped;
    ByTile<Number> triangles;    // all triangles that overlap a tile, except those in `fragments`
    ByTile<Fragment> fragments;  // all samples that small triangles cover
  };
  Tessellation surfaces;                     // in scene coordinates
  std::unique_ptr<ScreenVertex[]> vertices;  // one for each of surfaces.vertices
  std::vector<Chunk> chunks;
  bool parallel = false;  // whether rays of the camera are parallel
  bool centred = false;   // whether all samples are in the centres of pixels. Otherwise nothing is a fragment
  int tiles_across = 0;

  const ClippedPart& clipped(Number number) const;
  ScreenTriangle triangle(Number number) const {
    if (number % kParts != 0) return clipped(number).triangle;
    const auto& [a, b, c] = surfaces.triangles[number / kParts].vertices;
    const ScreenVertex &p = vertices[a], &q = vertices[b], &r = vertices[c];
    return {{p.x, q.x, r.x}, {p.y, q.y, r.y}, {p.nearness, q.nearness, r.nearness}};
  }
  // Returns the size of the triangles and the lists, in bytes.
  std::size_t bytes() const;
};

// Largest number of triangles of a scene.
inline constexpr std::size_t kMaxScreenTriangles = 40'000'000;
static_assert(kMaxScreenTriangles <= std::numeric_limits<Screen::Number>::max() / Screen::kParts);

// Returns triangles that are within Plan::tessellation_error pixels of the surfaces of the scene at
// Plan::time, projected to the image of the plan. Uses oneTBB workers. Throws Cancelled, and InputError
// (/render/technique) if there are more than kMaxScreenTriangles. REQUIRES: the camera is not all-around.
std::shared_ptr<const Screen> make_screen(const Scene& scene, const Plan& plan);

}  // namespace orrery
