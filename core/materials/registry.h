#pragma once

#include <span>

#include "core/model/material.h"

namespace orrery {

// Returns all material types, in the order in which materials are numbered.
std::span<const MaterialType> material_types();

}  // namespace orrery
