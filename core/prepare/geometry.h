#pragma once

#include "core/model/world.h"

namespace orrery {

// The scene in number type T (float or double) as it stands during an exposure. Models get structures of type
// `inner`. `before`: the same at another, or null: what rests is shared with it, and structures of what moves
// follow from its own where they can.
template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner, const Exposure& exposure = {},
                                                 const Geometry<T>* before = nullptr);

// A structure over primitives, which follows from the one that they had at another moment if it can.
// `before`: that one, or null.
template <class T>
AcceleratorPtr<T> build_or_refit(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                 const Accelerator<T>* before);

// Of the structure of a scene and those of its models: bytes and references of all, and the longest way.
template <class T>
AcceleratorFacts facts_of(const World<T>& world);

}  // namespace orrery
