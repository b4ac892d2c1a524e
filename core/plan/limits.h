#pragma once

#include <cstdint>

#include "core/model/counts.h"

namespace orrery {

// Limits of every scene and request.
inline constexpr int kMaxImageSide = 4096;
inline constexpr std::int64_t kMaxImagePixels = 16'777'216;
inline constexpr double kMinSize = 1e-90;  // metres, of a primitive; its cube does not underflow
inline constexpr int kMaxSamples = 4096;
inline constexpr int kMaxDepth = kMaxRayDepth;
inline constexpr int kMaxReuse = 64;
inline constexpr double kMaxBudgetSeconds = 3600;
inline constexpr int kMaxLights = 1024;
inline constexpr int kMaxObjects = 1'000'000;
inline constexpr std::size_t kMaxInstanced = 20'000'000;  // sum of the primitives of all instances
inline constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53;
inline constexpr double kMaxOrbitDegrees = 1e9;
inline constexpr double kMinOrbitDistance = 1e-3, kMaxOrbitDistance = 1e3;

}  // namespace orrery
