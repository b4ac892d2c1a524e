#pragma once

#include <memory>
#include <optional>

#include "core/math/keyframes.h"
#include "core/meshes/repair.h"

namespace orrery {

using SharedVectors = std::shared_ptr<const std::vector<Vec3d>>;

// Vertex positions of a mesh at one time, with one normal per vertex or none.
struct VertexKey {
  SharedVectors positions, normals;
};

// Interpolates vertices linearly, and renormalizes normals.
VertexKey mix(const VertexKey& before, const VertexKey& after, double share);

// Mesh with moving vertices. Keeps triangles that have no area for a while.
struct MovingMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 2>> uvs;  // one per vertex, or empty
  Keyframes<VertexKey> keys;
  // If set, smooth_normals() computes the normals, around vertices that coincide at the time. If that
  // compares more than `max_pairs` pairs, because many vertices meet for a moment, only those that coincide
  // at all keys are used.
  std::optional<double> crease_degrees;
  PositionIndices always;  // vertices that coincide at all keys
  std::uint64_t max_pairs;

  // Returns the mesh at `time`, in seconds, with its triangles in the same order. Thread-safe. Throws
  // Cancelled.
  TriangleMesh at(double time) const;
  // Returns vectors for all corners, three per triangle, to interpolate between the moments of an exposure:
  // the keys' normals, or the smoothed normals at `time`. Empty for a flat mesh.
  std::vector<Vec3d> corner_normals(double time) const;
};

}  // namespace orrery
