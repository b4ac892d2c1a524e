#pragma once

#include "core/model/world.h"

namespace orrery {

// Returns the scene geometry in number type T (float or double) for an exposure. Models get acceleration
// structures of type `inner`. `before` is the geometry for another exposure, or null. Static parts are shared
// with `before`, and structures of moving parts are refitted if possible. Throws Cancelled, and the errors of
// AcceleratorType.
template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner, const Exposure& exposure = {},
                                                 const Geometry<T>* before = nullptr);

// Returns the parts of the scene geometry that techniques read if they rasterize: materials and lights, but
// no shapes, primitives, emitters or light tree.
template <class T>
std::shared_ptr<const Geometry<T>> make_lighting(std::shared_ptr<const Scene> scene);

// Returns an acceleration structure over the primitives. `before` is the structure for another exposure, or
// null. The result is `before` refitted if possible, and otherwise a new structure. Throws Cancelled, and the
// errors of AcceleratorType.
template <class T>
AcceleratorPtr<T> build_or_refit(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                 const Accelerator<T>* before);

// Returns the facts of the scene's structure, including the structures of the models. Bytes and references
// are totals. The depth is the depth of the scene's structure plus the largest depth of a model's structure.
// If the technique rasterizes, returns the size of World::screen and its number of triangles.
template <class T>
AcceleratorFacts facts_of(const World<T>& world);

}  // namespace orrery
