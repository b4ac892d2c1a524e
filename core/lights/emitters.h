#pragma once

#include <optional>
#include <span>

#include "core/lights/emitter.h"
#include "core/math/affine.h"
#include "core/model/light.h"

namespace orrery {

// Returns the emitter of a patch in world coordinates. `radiance` is emitted on both sides.
Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance);

// Transforms a patch of a model to the world and returns its emitter. Returns nullopt if the transformed
// surface is not a Patch, for example an ellipsoid or a rectangle without right angles.
std::optional<Emitter<double>> make_emitter(const Patch& patch, const Vec3d& radiance,
                                            const Affined& world_from_model);

// Returns a kernel whose light i is emitters[i].
template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters);

// Returns the bounds of an emitter for light selection. The strength is twice the radiance of the brightest
// channel. Far away, the estimate follows the inverse-square law, in proportion to the emitter's area.
LightBounds bounds_of(const Emitter<double>& emitter);

}  // namespace orrery
