#pragma once

#include "core/model/world.h"

namespace orrery {

// Returns the scene geometry in number type T (float or double) during an exposure. Models get structures of
// type `inner`. `before` is the geometry at another exposure, or null: static parts are shared with it, and
// structures of moving parts are refitted if possible. Throws Cancelled, and the errors of AcceleratorType.
template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner, const Exposure& exposure = {},
                                                 const Geometry<T>* before = nullptr);

// Returns a structure over the primitives: `before`, the structure at another moment or null, refitted if
// possible, or else a new one. Throws Cancelled, and the errors of AcceleratorType.
template <class T>
AcceleratorPtr<T> build_or_refit(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                 const Accelerator<T>* before);

// Returns the facts of the scene's structure and those of its models: total bytes and references, and the
// largest depth.
template <class T>
AcceleratorFacts facts_of(const World<T>& world);

}  // namespace orrery
