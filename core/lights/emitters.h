#pragma once

#include <optional>
#include <span>

#include "core/lights/emitter.h"
#include "core/math/affine.h"
#include "core/model/light.h"

namespace orrery {

Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance);

// Of a patch of a model, where an instance stands; none if it is no patch there, as a sphere that becomes an
// ellipsoid, or a rectangle whose sides are not at right angles any more.
std::optional<Emitter<double>> make_emitter(const Patch& patch, const Vec3d& radiance,
                                            const Affined& world_from_model);

// A kernel of such surfaces, in this order.
template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters);

// What is seen of it from near is taken for a hemisphere full of its radiance, and from far for its area.
LightBounds bounds_of(const Emitter<double>& emitter);

}  // namespace orrery
