#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math/vec3.h"

// Typical meshes for both sides of a comparison.
namespace orrery::bench {

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<unsigned, 3>> triangles;
};

// Mesh in the unit sphere, eye point, and a square light given by its centre and side.
struct Subject {
  Mesh mesh;
  Vec3f eye{0.7f, 0.9f, 2.6f};
  Vec3f light{1.1f, 2.2f, 1.3f};
  float light_size = 0.8f;
};

// Returns the names of the generated subjects.
std::vector<std::string> subject_names();

// Returns a generated subject of about `triangles` triangles, or a mesh file (OBJ, PLY, STL, GLB) with all
// its triangles, scaled into the unit sphere. Throws Error if `name` is neither.
Subject subject_of(const std::string& name, int triangles);

// Adds a cube of 12 triangles around the subject and its eye, so that every ray hits.
void put_in_room(Mesh& mesh);

}  // namespace orrery::bench
