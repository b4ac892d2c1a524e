#pragma once

#include <optional>
#include <span>

#include "core/lights/emitter.h"
#include "core/math/affine.h"
#include "core/model/light.h"

namespace orrery {

Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance);

// Transforms a model's patch to the world. Returns nullopt if the result is not a patch, such as an ellipsoid
// from a sphere or a rectangle without right angles.
std::optional<Emitter<double>> make_emitter(const Patch& patch, const Vec3d& radiance,
                                            const Affined& world_from_model);

// Makes a kernel whose lights are the emitters, in this order.
template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters);

// Returns bounds of an emitter. The strength is twice its radiance. Far away, the estimate follows the
// inverse-square law of its area.
LightBounds bounds_of(const Emitter<double>& emitter);

}  // namespace orrery
