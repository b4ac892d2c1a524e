#pragma once

#include "core/math/bounds.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

// Measures of a mesh, in the units of its file.
struct MeshInspection {
  std::size_t triangles_without_area = 0;
  Boundsd bounds;           // bounds of the corners of triangles
  bool watertight = false;  // the triangles enclose a volume: see is_watertight()
  double area = 0;          // sum over the triangles
  double volume = 0;        // enclosed volume, negative if the fronts face inward; 0 unless watertight
};

// Throws Cancelled. REQUIRES: valid indices and finite coordinates, as returned by read_mesh.
MeshInspection inspect_mesh(const TriangleMesh& mesh);

}  // namespace orrery
