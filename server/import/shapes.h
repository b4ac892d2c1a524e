#pragma once

#include <array>
#include <string>

#include "server/import/scene_writer.h"

// Shapes of scene descriptions as objects of scenes. `map` is the map from the object to the scene.
namespace orrery {

// Part of a quadric around the z axis.
struct Sweep {
  double degrees = 360;  // angle from +x toward +y
  bool is_full() const { return degrees >= 360; }
};

// Sphere about the origin, between z_min and z_max. A whole sphere stays one; other parts become rational
// Bezier patches.
void add_sphere(SceneWriter& scene, const Affined& map, double radius, double z_min, double z_max,
                const Sweep& sweep, const std::string& material);
// Disk or ring at z = height.
void add_disk(SceneWriter& scene, const Affined& map, double height, double radius, double inner_radius,
              const Sweep& sweep, const std::string& material);
// Cylinder without caps, as rational Bezier patches.
void add_cylinder(SceneWriter& scene, const Affined& map, double radius, double z_min, double z_max,
                  const Sweep& sweep, const std::string& material);
// Parallelogram with a corner and two sides.
void add_parallelogram(SceneWriter& scene, const Affined& map, const Vec3d& corner, const Vec3d& side_u,
                       const Vec3d& side_v, const std::string& material);
// Box between -1 and 1.
void add_cube(SceneWriter& scene, const Affined& map, const std::string& material);
// Bilinear patch with the corners (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
void add_bilinear_patch(SceneWriter& scene, const Affined& map, const std::array<Vec3d, 4>& corners,
                        const std::string& material);
// Mesh with positions and normals of the object. Turns the triangles over if the map mirrors, so that their
// front stays, and once more with `reversed`.
void add_triangles(SceneWriter& scene, const Affined& map, TriangleMesh mesh, bool reversed,
                   const std::string& material);

// Area of the triangles after the map.
double area_of(const TriangleMesh& mesh, const Affined& map);

}  // namespace orrery
