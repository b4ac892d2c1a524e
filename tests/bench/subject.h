#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math/vec3.h"

// Meshes of the natures that users have, for both sides of a comparison.
namespace orrery::bench {

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<unsigned, 3>> triangles;
};

// A mesh in the unit sphere, where to look at it from, and a light: its middle and the side of its square.
struct Subject {
  Mesh mesh;
  Vec3f eye{0.7f, 0.9f, 2.6f};
  Vec3f light{1.1f, 2.2f, 1.3f};
  float light_size = 0.8f;
};

// The names that subject_of() knows beside mesh files.
std::vector<std::string> subject_names();

// A generated subject of about that many triangles, or a mesh file (OBJ, PLY, STL, GLB), scaled into the unit
// sphere, whose triangles are as many as they are. Throws Error if it is neither.
Subject subject_of(const std::string& name, int triangles);

// Adds the 12 triangles of a cube around the subject and its eye, so that every ray meets something.
void put_in_room(Mesh& mesh);

}  // namespace orrery::bench
