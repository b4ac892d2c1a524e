#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/model/tile.h"

// Cameras. Coordinates are right-handed, in metres. Angles in scenes and requests are in degrees.
namespace orrery {

class Params;

inline constexpr int kMaxBlades = 16;

// Aperture shape: a regular polygon whose corners are at the aperture radius from the centre.
struct LensBlades {
  int count = 0;       // number of sides, at least 3; 0: round
  double degrees = 0;  // angle of the first corner, from right toward up
};

// Placement of the camera in the scene file.
struct CameraPlacement {
  Vec3d eye{0, 0, 4}, look_at{0, 0, 0}, up{0, 1, 0};
  double aperture_radius = 0;                 // radius of the thin lens, metres; 0: pinhole
  std::optional<double> focus_distance = {};  // along the view axis, metres; nullopt: distance to look_at
  LensBlades blades = {};
};

// Camera position on an orbit, relative to the camera of the scene. The azimuth turns about `up` through
// `look_at`, anticlockwise seen from above: x' = x cos + z sin, z' = -x sin + z cos for up = y. The elevation
// raises the camera toward `up`. `distance` is a factor of the scene camera's distance from look_at. `pan`
// then translates the camera, in metres, in scene coordinates.
struct Orbit {
  double azimuth_degrees = 0, elevation_degrees = 0, distance = 1;
  Vec3d pan{0, 0, 0};
};

// Camera position and orthonormal axes.
struct CameraFrame {
  Vec3d eye, right, up, back;
  double distance = 0;     // from eye to look_at, metres
  double half_extent = 0;  // half the image height: see Camera::half_extent()
  double aperture_radius = 0, focus_distance = 0;
  LensBlades blades;
};

// Sample positions within the pixels of a tile, one per batch element. Positions are in [0, 1), but exceed
// this range for filters wider than a pixel.
struct TileSamples {
  Array<float> u, v;

  static TileSamples centres() {
    TileSamples samples;
    samples.u.values.fill(0.5f);
    samples.v.values.fill(0.5f);
    return samples;
  }
};

// Camera model that generates rays. Each camera type is a derived class. Immutable and thread-safe.
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
  // Returns true if rays leave in all directions. Such a camera has no focal plane.
  virtual bool all_around() const { return false; }
  // Returns half the image height: in metres for parallel cameras, in radians for all-around cameras, and on
  // the plane 1 m from the eye for others. `distance` is Orbit::distance.
  virtual double half_extent(double distance) const = 0;
  // Returns a copy with another vertical field of view, in (0, 180) degrees, or null if the type has no field
  // of view.
  virtual std::unique_ptr<Camera> with_fov(double /*degrees*/) const { return nullptr; }

  // Generates the rays of a tile of an image of `width` x `height` pixels, one per batch element. Rays of
  // pixels outside the image are inactive.
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

// Returns the frame of `camera` at `orbit`. The elevation is clamped to straight above and straight below. At
// both poles, the azimuth still defines the image orientation, because nothing is divided by the cosine of
// the elevation. REQUIRES: eye, look_at and up are not collinear.
CameraFrame frame_at(const CameraPlacement& placement, const Camera& camera, const Orbit& orbit);

// Pixel width in metres across the ray: `width` at the origin of the ray, plus `spread` per metre along the
// ray.
struct PixelFootprint {
  double width, spread;
};
inline PixelFootprint pixel_footprint(const CameraFrame& frame, const Camera& camera, int height) {
  const double pixel = 2 * frame.half_extent / height;
  return camera.parallel() ? PixelFootprint{pixel, 0} : PixelFootprint{0, pixel};
}

}  // namespace orrery
