#pragma once

#include "core/model/batch.h"

namespace orrery {

enum class Projection { perspective, orthographic };

// Where the picture is taken from. Right-handed; metres; degrees.
struct Camera {
  Projection projection = Projection::perspective;
  Vec3d eye{0, 0, 4}, look_at{0, 0, 0}, up{0, 1, 0};
  double fov_degrees = 45;  // perspective: vertical angle of the picture, for any aspect
  double height = 2;        // orthographic: metres that the picture's height shows
};

// A place on an orbit, relative to the scene's own camera: a turn about `up` through `look_at` (anticlockwise
// seen from above, x' = x cos + z sin, z' = -x sin + z cos for up = y), a lift toward `up`, and a factor of
// the own distance; all of it moved by `pan`, in metres of the scene's space.
struct Orbit {
  double azimuth_degrees = 0, elevation_degrees = 0, distance = 1;
  Vec3d pan{0, 0, 0};
};

// The camera's place and directions, unit and at right angles to each other.
struct CameraFrame {
  Vec3d eye, right, up, back;
  Projection projection;
  double half_extent;  // half the picture's height: of the plane at distance 1, or in metres if orthographic
  double distance;     // from eye to look_at
};

// The frame at `orbit`. The lift stops at straight above and below, where the picture stays upright by
// azimuth: nothing is divided by the cosine of the elevation. REQUIRES: eye, look_at and up span a plane.
CameraFrame frame_at(const Camera& camera, const Orbit& orbit);

// The side of the square of pixels that one batch of camera rays covers.
inline constexpr int kTileSide = 32;
static_assert(kTileSide * kTileSide == kBatch);

// Pixel of slot `slot` within its tile. Slots run in blocks of 4x4 pixels, so that the rays of one register
// are neighbours whatever its width.
struct TilePixel {
  int x, y;
};
constexpr TilePixel tile_pixel(int slot) {
  const int block = slot / 16, within = slot % 16;
  constexpr int kBlocks = kTileSide / 4;
  return {block % kBlocks * 4 + within % 4, block / kBlocks * 4 + within / 4};
}

// Where in its pixel each slot of a tile is sampled, in [0, 1).
struct TileSamples {
  Array<float> u, v;
};

// One ray a slot for the tile whose first pixel is (x0, y0) of a width x height picture; pixels beyond the
// picture get inactive rays. Row 0 is the top.
template <class T>
void generate_rays(const CameraFrame& frame, int width, int height, int x0, int y0,
                   const TileSamples& samples, RayBatch<T>& out);

}  // namespace orrery
