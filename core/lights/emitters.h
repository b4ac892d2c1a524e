#pragma once

#include <span>

#include "core/lights/emitter.h"
#include "core/model/light.h"

namespace orrery {

Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance);

// A kernel of such surfaces, in this order.
template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters);

// What is seen of it from near is taken for a hemisphere full of its radiance, and from far for its area.
LightBounds bounds_of(const Emitter<double>& emitter);

}  // namespace orrery
