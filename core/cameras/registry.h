#pragma once

#include <span>

#include "core/model/camera.h"

namespace orrery {

std::span<const CameraType> camera_types();

}  // namespace orrery
