#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/model/tile.h"

// Cameras. Right-handed; metres; degrees in scenes and requests.
namespace orrery {

class Params;

inline constexpr int kMaxBlades = 16;

// The aperture's form: a regular polygon, whose corners are as far from the middle as its radius.
struct LensBlades {
  int count = 0;       // sides, at least 3; 0: round
  double degrees = 0;  // of the first corner, from right toward up
};

// Where a scene's own camera stands.
struct CameraPlacement {
  Vec3d eye{0, 0, 4}, look_at{0, 0, 0}, up{0, 1, 0};
  double aperture_radius = 0;                 // of a thin lens, metres; 0: a pinhole
  std::optional<double> focus_distance = {};  // along the view, metres; none: where look_at is
  LensBlades blades = {};
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
  double distance = 0;     // from eye to look_at, metres
  double half_extent = 0;  // half the picture's height: see Camera::half_extent()
  double aperture_radius = 0, focus_distance = 0;
  LensBlades blades;
};

// Where each slot of a tile is sampled: in its pixel in [0, 1), or beyond with a filter that is wider.
struct TileSamples {
  Array<float> u, v;

  static TileSamples centres() {
    TileSamples samples;
    samples.u.values.fill(0.5f);
    samples.v.values.fill(0.5f);
    return samples;
  }
};

// How rays leave the camera: one object a type. Const and free of state.
class Camera {
 public:
  virtual ~Camera() = default;

  // Name and value of what a scene says about this type beside the placement.
  struct Parameter {
    const char* name;
    double value;
  };
  virtual std::vector<Parameter> parameters() const = 0;
  virtual const char* type() const = 0;
  // Whether all rays have one direction.
  virtual bool parallel() const = 0;
  // Whether rays leave toward all sides, so that there is no plane that a lens could be focused at.
  virtual bool all_around() const { return false; }
  // Half the picture's height: in metres if parallel, else of the plane at distance 1 from the eye.
  // `distance` is the orbit's factor of the own distance. In radians if all around.
  virtual double half_extent(double distance) const = 0;
  // The same with another vertical angle, in (0, 180) degrees; null if it has no angle.
  virtual std::unique_ptr<Camera> with_fov(double /*degrees*/) const { return nullptr; }

  // One ray a slot for a tile of a picture of width x height pixels; slots beyond the tile's pixels get
  // inactive rays.
  virtual void generate(const CameraFrame& frame, int width, int height, const TileView& tile,
                        const TileSamples& samples, RayBatch<float>& out) const = 0;
  virtual void generate(const CameraFrame& frame, int width, int height, const TileView& tile,
                        const TileSamples& samples, RayBatch<double>& out) const = 0;
};

struct CameraType {
  const char* name;
  const char* summary;
  std::unique_ptr<Camera> (*read)(Params&);
};

// The frame of `camera` at `orbit`. The lift stops at straight above and below, where the picture stays
// upright by azimuth: nothing is divided by the cosine of the elevation. REQUIRES: eye, look_at and up span a
// plane.
CameraFrame frame_at(const CameraPlacement& placement, const Camera& camera, const Orbit& orbit);

// Metres across the ray that a pixel covers: `width` at the ray's origin, and `spread` more per metre.
struct PixelFootprint {
  double width, spread;
};
inline PixelFootprint pixel_footprint(const CameraFrame& frame, const Camera& camera, int height) {
  const double pixel = 2 * frame.half_extent / height;
  return camera.parallel() ? PixelFootprint{pixel, 0} : PixelFootprint{0, pixel};
}

}  // namespace orrery
