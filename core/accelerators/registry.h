#pragma once

#include <span>

#include "core/model/accelerator.h"

namespace orrery {

std::span<const AcceleratorType> accelerator_types();

}  // namespace orrery
