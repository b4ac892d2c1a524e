#pragma once

#include <memory>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/model/tessellation.h"

// Scan line rendering: tessellation of a scene, projection, and a z-buffer for each tile. Immutable objects
// may be shared by threads. Functions throw only what their comments state, and std::bad_alloc.
namespace orrery {

// Image coordinates are integers: 1 / kSubpixels pixels from the left and the upper edge of the image. All
// edge functions and areas of triangles are then exact in double precision.
inline constexpr int kSubpixels = 1024;

// Triangle in the image, clipped to a region larger than the image.
struct ScreenTriangle {
  std::array<std::int32_t, 3> x, y;  // subpixels
  std::array<double, 3> nearness;    // larger is nearer: 1 / depth, or -depth for parallel cameras
  std::uint32_t triangle;            // in Tessellation::triangles
  std::int32_t clipped = -1;         // in Chunk::corners, or -1: the corners are those of `triangle`
};

// Triangles of a scene in one image, sorted by tile.
struct Screen {
  // Weights of the corners of a triangle at each corner of the clipped triangle.
  using Corners = std::array<Vec3d, 3>;
  // Part of the triangles, in the order of Tessellation::triangles. The triangles that overlap tile t of
  // TileGrid are list[first[t]] to list[first[t + 1] - 1], in ascending order.
  struct Chunk {
    std::vector<ScreenTriangle> triangles;
    std::vector<Corners> corners;
    std::vector<std::uint32_t> first, list;
  };
  Tessellation surfaces;  // in scene coordinates
  std::vector<Chunk> chunks;
  bool parallel = false;  // whether rays of the camera are parallel
  int tiles_across = 0;

  // Returns the size of the triangles and the lists, in bytes.
  std::size_t bytes() const;
};

// Largest number of triangles of a scene.
inline constexpr std::size_t kMaxScreenTriangles = 40'000'000;

// Returns triangles that are within Plan::tessellation_error pixels of the surfaces of the scene at
// Plan::time, projected to the image of the plan. Uses oneTBB workers. Throws Cancelled, and InputError
// (/render/technique) if there are more than kMaxScreenTriangles. REQUIRES: the camera is not all-around.
std::shared_ptr<const Screen> make_screen(const Scene& scene, const Plan& plan);

}  // namespace orrery
