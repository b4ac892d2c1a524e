#pragma once

#include "core/model/light.h"
#include "tests/support/scenes.h"

// Evaluation of one light at single points.
namespace orrery::test {

// Light that arrives at a point.
template <class T>
struct IncidentLight {
  Vec3<T> direction;  // toward the light
  T t_max;            // metres to the light, infinite if distant, -1 if no light arrives
  Vec3<T> incident;
};

template <class T>
IncidentLight<T> arrival(const Json& light, const Vec3<T>& at);

}  // namespace orrery::test
