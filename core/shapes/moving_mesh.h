#pragma once

#include <memory>
#include <optional>

#include "core/math/keyframes.h"
#include "core/meshes/repair.h"

namespace orrery {

using SharedVectors = std::shared_ptr<const std::vector<Vec3d>>;

// Vertex positions of a mesh at one time, with one normal per vertex or no normals.
struct VertexKey {
  SharedVectors positions, normals;
};

// Interpolates positions and normals linearly with `share` in (0, 1), and renormalizes the normals. If two
// normals cancel, returns the normal of `before`.
VertexKey mix(const VertexKey& before, const VertexKey& after, double share);

// Mesh with moving vertices. Keeps triangles that are degenerate at some times.
struct MovingMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 2>> uvs;  // one per vertex, or empty
  Keyframes<VertexKey> keys;
  // If set, at(time) calls smooth_normals() with the vertices that coincide at `time`. If smoothing would
  // compare more than `max_pairs` triangle pairs, because many vertices coincide for a moment, at() uses
  // `always` instead.
  std::optional<double> crease_degrees;
  PositionIndices always;  // vertices that coincide at all keys
  std::uint64_t max_pairs;

  // Returns the mesh at `time`, in seconds, with its triangles in the same order. Thread-safe. Throws
  // Cancelled.
  TriangleMesh at(double time) const;
  // Returns three normals per triangle, to be interpolated between the moments of an exposure: the smoothed
  // normals at `time` if `crease_degrees` is set, else the interpolated normals of the keys, not
  // renormalized. Returns an empty list for a mesh without normals. Thread-safe. Throws Cancelled.
  std::vector<Vec3d> corner_normals(double time) const;
};

}  // namespace orrery
