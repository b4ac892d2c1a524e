#pragma once

#include "core/model/shape.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {

// Triangles of one mesh during an exposure. Each vertex is on a straight line from one moment to the next.
struct MovingTriangles {
  std::size_t first;                        // number of its first triangle within the set
  std::vector<double> moments;              // seconds, from the opening of the shutter to its closing
  std::vector<SharedVectors> positions;     // by moment
  std::vector<std::vector<Vec3d>> normals;  // by moment: see MovingMesh::corner_normals()
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 2>> uvs;  // one a vertex, or none
};

// REQUIRES: in the order of their triangles.
std::unique_ptr<MovingShapes> moving_triangles(std::vector<MovingTriangles> meshes);

}  // namespace orrery
