#pragma once

#include <span>

#include "core/model/environment.h"

namespace orrery {

std::span<const EnvironmentType> environment_types();

}  // namespace orrery
