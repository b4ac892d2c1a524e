#pragma once

#include <span>

#include "core/model/technique.h"

namespace orrery {

std::span<const TechniqueType> technique_types();

}  // namespace orrery
