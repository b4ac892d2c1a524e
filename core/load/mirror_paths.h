#pragma once

#include <array>
#include <string>

#include "core/load/placed_primitives.h"
#include "core/model/camera.h"

namespace orrery {

// Measures how curved mirrors that reflect each other multiply rounding errors. Follows camera rays from
// mirror to mirror, together with neighbouring rays. Used by one thread at a time.
class MirrorPaths {
 public:
  // REQUIRES: both arguments live longer. `magnitude` is the largest coordinate in metres, the eye included.
  MirrorPaths(const Scene& scene, const PlacedPrimitives& primitives, double magnitude);

  // Traces the camera rays of the scene from four sides, one ray in `stride` of an image of 32 x 32 pixels.
  // Does nothing if no primitive is a mirror.
  void trace(int stride);

  // Returns the largest turns of all traces.
  const MirrorTurns& turns() const { return turns_; }

 private:
  struct Hit {
    const PlacedPrimitive* primitive;
    SurfaceAt at;
  };
  using Squares = std::array<double, MirrorTurns::kDepths + 1>;

  void trace_view(const CameraFrame& frame, int stride);
  std::optional<Hit> nearest(const Ray<double>& ray);
  void follow(const Ray<double>& from, Squares& squares);

  const Scene& scene_;
  const PlacedPrimitives& primitives_;
  const double least_, shift_, error_;  // metres: see mirror_paths.cpp
  PrimitiveTester tester_;
  MirrorTurns turns_;
};

}  // namespace orrery
