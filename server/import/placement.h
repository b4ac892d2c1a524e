#pragma once

#include <optional>

#include "core/math/affine.h"

namespace orrery {

inline Affined translation(const Vec3d& by) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by}; }
inline Affined scaling(const Vec3d& by) { return {{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}}; }

// Map from camera space to the scene, as of `LookAt` in pbrt and `lookat` in Mitsuba: +z is the viewing
// direction, +y is up, and +x is up x forward. REQUIRES: the points differ, and `up` is not parallel to their
// difference.
Affined looking_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

// Parts of a map, in the order of their application: see instances in docs/scene-format.md.
struct InstanceParts {
  Vec3d scale{1}, axis{0, 1, 0};
  double degrees = 0;
  Vec3d translate;
};

// Returns the parts of a map whose axes stay at right angles, within kMaxSkew of their cosines, or nullopt.
std::optional<InstanceParts> instance_parts(const Affined& map);
// Returns the parts of a map without its shear: lengths and the first two directions of the axes stay.
// REQUIRES: scaled_determinant(map) != 0.
InstanceParts nearest_instance_parts(const Affined& map);
inline constexpr double kMaxSkew = 1e-5;  // descriptions have numbers of six digits

// Returns the factor of a map that changes all lengths alike, within kMaxSkew, or nullopt.
std::optional<double> uniform_scale(const Affined& map);

bool is_identity(const Affined& map);

}  // namespace orrery
