#pragma once

#include <memory>
#include <optional>

#include "core/math/keys.h"
#include "core/meshes/repair.h"

namespace orrery {

using SharedVectors = std::shared_ptr<const std::vector<Vec3d>>;

// Where the vertices of a mesh are, and what they are shaded with: as many of each, or no normals.
struct VertexKey {
  SharedVectors positions, normals;
};

// Each vertex on a straight line; normals of length 1 again.
VertexKey mix(const VertexKey& before, const VertexKey& after, double share);

// A mesh whose vertices move. Triangles that have no area for a while stay.
struct MovingMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 2>> uvs;  // one a vertex, or none
  Keys<VertexKey> keys;
  // If there is a crease, normals are those of smooth_normals(): of vertices that stand together, or, where
  // that compares more than `most_pairs` because much of the mesh meets for a moment, of those that do so at
  // all keys.
  std::optional<double> crease_degrees;
  PositionIndices always;  // together at all keys
  std::uint64_t most_pairs;

  // The mesh as it stands at `time`, in seconds. Its triangles keep their order.
  TriangleMesh at(double time) const;
  // Directions from which those of all corners, three a triangle, come by being mixed between the moments of
  // an exposure: the keys' own, or those smoothed at that moment. None of a flat mesh.
  std::vector<Vec3d> corner_normals(double time) const;
};

}  // namespace orrery
