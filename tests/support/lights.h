#pragma once

#include "core/model/light.h"
#include "tests/support/scenes.h"

// One light, asked directly about single points.
namespace orrery::test {

// What arrives at a point.
template <class T>
struct ArrivingLight {
  Vec3<T> direction;  // toward the light
  T t_max;            // metres to it, infinite for a distant one, -1: no light arrives
  Vec3<T> incident;
};

template <class T>
ArrivingLight<T> arrival(const Json& light, const Vec3<T>& at);

}  // namespace orrery::test
