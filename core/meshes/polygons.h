#pragma once

#include <cstdint>
#include <vector>

#include "core/meshes/mesh_file.h"

namespace orrery {

// Polygon of a file, which its reader has divided into a fan: count - 2 triangles from number `first`, that
// share the first corner.
struct Fan {
  std::uint32_t first, count;
};

// Replaces the fans of polygons that are not convex. Polygons are projected along their own normal (Newell's
// method) and divided by clipping ears (Meisters, "Polygons have ears", 1975), which covers exactly the area
// of a simple polygon. A hole may be connected by an edge that is used twice. Adds notes about polygons that
// cross themselves, which have no such division, and about concave ones of more than 4,096 corners, which
// stay fans. Throws Cancelled. REQUIRES: valid fans, indices and finite coordinates.
void divide_polygons(const std::vector<Fan>& fans, TriangleMesh& mesh);

}  // namespace orrery
