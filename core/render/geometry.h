#pragma once

#include "core/model/world.h"

namespace orrery {

// The scene in number type T (float or double). Models get structures of type `inner`.
template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner);

}  // namespace orrery
