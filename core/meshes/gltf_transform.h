#pragma once

#include <algorithm>

#include "core/math/vec3.h"
#include "core/meshes/gltf_json.h"

namespace orrery {

// p -> x p.x + y p.y + z p.z + origin.
struct Affine {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d point(const Vec3d& p) const { return vector(p) + origin; }

  // The linear part over its largest entry, so that products of three entries stay in range.
  Affine scaled() const {
    const double largest = std::max({max_component(abs(x)), max_component(abs(y)), max_component(abs(z))});
    return largest > 0 ? Affine{x / largest, y / largest, z / largest, {}} : *this;
  }
  // Whether it turns anticlockwise into clockwise.
  bool mirrors() const {
    const Affine s = scaled();
    return dot(s.x, cross(s.y, s.z)) < 0;
  }
  // The normal of a transformed surface, of any length: by the inverse transpose, which is the matrix of
  // cofactors over the determinant.
  Vec3d normal(const Vec3d& n) const {
    const Affine s = scaled();
    const Vec3d turned = cross(s.y, s.z) * n.x + cross(s.z, s.x) * n.y + cross(s.x, s.y) * n.z;
    return mirrors() ? -turned : turned;
  }
};

// First `inner`, then `outer`.
inline Affine compose(const Affine& outer, const Affine& inner) {
  return {outer.vector(inner.x), outer.vector(inner.y), outer.vector(inner.z), outer.point(inner.origin)};
}

// The transform of a node to its parent: its matrix, or translation * rotation * scale. Throws InputError.
Affine transform_of(const GltfValue& node);

}  // namespace orrery
