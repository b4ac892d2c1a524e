#pragma once

#include "core/model/shape.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {

// Triangles of one mesh during an exposure. Each vertex moves in a straight line between consecutive moments.
struct MovingTriangles {
  std::size_t first;                        // index of the mesh's first triangle in the set
  std::vector<double> moments;              // seconds, from shutter opening to closing
  std::vector<SharedVectors> positions;     // by moment
  std::vector<std::vector<Vec3d>> normals;  // by moment: see MovingMesh::corner_normals()
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 2>> uvs;  // one per vertex, or empty
};

// Returns the moving triangles of a set. REQUIRES: `meshes` is not empty and sorted by `first`.
std::unique_ptr<MovingShapes> moving_triangles(std::vector<MovingTriangles> meshes);

}  // namespace orrery
