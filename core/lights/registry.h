#pragma once

#include <span>

#include "core/model/light.h"

namespace orrery {

std::span<const LightType> light_types();

}  // namespace orrery
