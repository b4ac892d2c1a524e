#pragma once

#include <span>

#include "core/lights/emitter.h"
#include "core/model/light.h"

namespace orrery {

Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance);

// A kernel of such surfaces, in this order.
template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters);

// Watts that one sends out, per pi, in its brightest channel.
double power_of(const Emitter<double>& emitter);

}  // namespace orrery
