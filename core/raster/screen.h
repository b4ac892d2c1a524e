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

// Objects at equal distances in memory.
template <class X>
struct Strided {
  const X* first = nullptr;
  std::size_t stride = sizeof(X);  // bytes

  const X& operator[](std::size_t i) const {
    return *reinterpret_cast<const X*>(reinterpret_cast<const std::byte*>(first) + i * stride);
  }
};

// Elements of tiles of TileGrid, sorted by tile.
template <class X>
struct ByTile {
  std::vector<X> elements;
  std::vector<std::uint32_t> first;  // indices in `elements`, by tile from `first_tile` on
  std::uint32_t first_tile = 0;

  std::span<const X> of(std::uint32_t tile) const {
    const std::size_t i = tile - first_tile;
    if (tile < first_tile || i + 1 >= first.size()) return {};
    return {elements.data() + first[i], elements.data() + first[i + 1]};
  }
};

// Triangles of a scene in one image, sorted by tile.
struct Screen {
  // Triangles that are stored in one place, and their vertices.
  struct Block {
    std::uint32_t first = 0, size = 0;  // number of the first triangle, and how many there are
    std::size_t first_vertex = 0;       // index of positions[0] in Screen::vertices
    Strided<std::array<std::uint32_t, 3>> corners = {};  // anticlockwise as seen from outside
    Strided<Vec3d> positions = {};
    Strided<Vec3d> normals = {};  // outward unit normals, or 0: that of the triangle. Null if all are 0
    Strided<std::int32_t> primitives = {};  // null if they ascend from first_primitive
    std::int32_t first_primitive = 0;
  };
  // Number of a part of a triangle: kParts times the number of the triangle. Parts of a clipped triangle add
  // 1, 2, ...
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
  // Up to kChunk consecutive triangles of a block. All lists are in ascending order of numbers, within tiles
  // if sorted by tile.
  struct Chunk {
    const Block* block = nullptr;
    std::vector<ClippedPart> clipped = {};
    ByTile<Number> triangles = {};    // all triangles that overlap a tile, except those in `fragments`
    ByTile<Fragment> fragments = {};  // all samples that small triangles cover
  };
  std::shared_ptr<const Scene> scene;        // owns meshes of `surfaces`
  Tessellation surfaces;                     // in scene coordinates
  std::vector<Block> blocks;                 // triangles of `surfaces`, in their order
  std::unique_ptr<ScreenVertex[]> vertices;  // all vertices of `surfaces`, then those of its meshes
  std::size_t vertex_count = 0;
  std::vector<Chunk> chunks;  // kChunk triangle numbers each
  bool parallel = false;      // whether rays of the camera are parallel
  bool centred = false;  // whether all samples are in the centres of pixels. Otherwise nothing is a fragment
  int tiles_across = 0;

  const Block& block_of(std::uint32_t triangle) const { return *chunks[triangle / kChunk].block; }
  std::int32_t primitive(std::uint32_t triangle) const {
    const Block& block = block_of(triangle);
    const std::uint32_t i = triangle - block.first;
    return block.primitives.first ? block.primitives[i] : block.first_primitive + static_cast<int>(i);
  }
  const ClippedPart& clipped(Number number) const;
  ScreenTriangle triangle(Number number) const {
    if (number % kParts != 0) return clipped(number).triangle;
    const Block& block = block_of(number / kParts);
    const auto& [a, b, c] = block.corners[number / kParts - block.first];
    const ScreenVertex* const at = &vertices[block.first_vertex];
    const ScreenVertex &p = at[a], &q = at[b], &r = at[c];
    return {{p.x, q.x, r.x}, {p.y, q.y, r.y}, {p.nearness, q.nearness, r.nearness}};
  }
  // Returns the size of the triangles and the lists, in bytes.
  std::size_t bytes() const;
};

// Largest number of triangles of a scene.
inline constexpr std::size_t kMaxScreenTriangles = 40'000'000;
static_assert(kMaxScreenTriangles <= std::numeric_limits<Screen::Number>::max() / Screen::kParts / 2);

// Returns triangles that are within Plan::tessellation_error pixels of the surfaces of the scene at
// Plan::time, projected to the image of the plan. Uses oneTBB workers. Throws Cancelled, and InputError
// (/render/technique) if there are more than kMaxScreenTriangles. REQUIRES: the camera is not all-around.
std::shared_ptr<const Screen> make_screen(std::shared_ptr<const Scene> scene, const Plan& plan);

}  // namespace orrery
