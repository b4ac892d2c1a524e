#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/model/tile.h"

// Cameras. Right-handed coordinates in metres; angles in degrees in scenes and requests.
namespace orrery {

class Params;

inline constexpr int kMaxBlades = 16;

// Aperture shape: a regular polygon whose corners lie at the aperture radius.
struct LensBlades {
  int count = 0;       // sides, at least 3; 0: round
  double degrees = 0;  // angle of the first corner, from right toward up
};

// Placement of a scene's own camera.
struct CameraPlacement {
  Vec3d eye{0, 0, 4}, look_at{0, 0, 0}, up{0, 1, 0};
  double aperture_radius = 0;                 // thin lens radius, metres; 0: pinhole
  std::optional<double> focus_distance = {};  // along the view, metres; nullopt: distance to look_at
  LensBlades blades = {};
};

// Camera position on an orbit, relative to the scene's own camera. The azimuth turns about `up` through
// `look_at`, anticlockwise seen from above: x' = x cos + z sin, z' = -x sin + z cos for up = y. The elevation
// lifts toward `up`. `distance` is a factor of the own distance. `pan` then moves the camera, in metres of
// the scene's space.
struct Orbit {
  double azimuth_degrees = 0, elevation_degrees = 0, distance = 1;
  Vec3d pan{0, 0, 0};
};

// Camera position and orthonormal axes.
struct CameraFrame {
  Vec3d eye, right, up, back;
  double distance = 0;     // from eye to look_at, metres
  double half_extent = 0;  // half the picture height: see Camera::half_extent()
  double aperture_radius = 0, focus_distance = 0;
  LensBlades blades;
};

// Sample positions of a tile's slots within their pixels, in [0, 1); wider filters go beyond that range.
struct TileSamples {
  Array<float> u, v;

  static TileSamples centres() {
    TileSamples samples;
    samples.u.values.fill(0.5f);
    samples.v.values.fill(0.5f);
    return samples;
  }
};

// Camera model that generates rays, one object per type. Immutable and thread-safe.
class Camera {
 public:
  virtual ~Camera() = default;

  // Name and value of a type-specific scene parameter.
  struct Parameter {
    const char* name;
    double value;
  };
  virtual std::vector<Parameter> parameters() const = 0;
  virtual const char* type() const = 0;
  // Returns true if all rays have the same direction.
  virtual bool parallel() const = 0;
  // Returns true if rays leave in all directions, so that no focal plane exists.
  virtual bool all_around() const { return false; }
  // Returns half the picture height. Parallel cameras: in metres. Others: on the plane at distance 1 from the
  // eye. All-around cameras: in radians. `distance` is the orbit's factor of the own distance.
  virtual double half_extent(double distance) const = 0;
  // Returns this camera with another vertical field of view, in (0, 180) degrees, or null if it has none.
  virtual std::unique_ptr<Camera> with_fov(double /*degrees*/) const { return nullptr; }

  // Generates one ray per slot for a tile of a picture of width x height pixels. Slots outside the picture
  // get inactive rays.
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

// Returns the frame of `camera` at `orbit`. The elevation is clamped to straight above and below, where the
// azimuth keeps the picture upright. No division by the cosine of the elevation occurs. REQUIRES: eye,
// look_at and up are not collinear.
CameraFrame frame_at(const CameraPlacement& placement, const Camera& camera, const Orbit& orbit);

// Pixel width in metres across the ray: `width` at the ray's origin plus `spread` per metre.
struct PixelFootprint {
  double width, spread;
};
inline PixelFootprint pixel_footprint(const CameraFrame& frame, const Camera& camera, int height) {
  const double pixel = 2 * frame.half_extent / height;
  return camera.parallel() ? PixelFootprint{pixel, 0} : PixelFootprint{0, pixel};
}

}  // namespace orrery
