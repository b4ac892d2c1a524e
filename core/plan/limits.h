#pragma once

#include <cstdint>

#include "core/model/counts.h"

namespace orrery {

// Limits of every scene and request. The limits of render options are ranges in the rows of options.cpp,
// which RenderOption::read_*() checks. The limits of scenes (kMinSize, kMaxLights, kMaxTextures,
// kMaxTextureTexels, kMaxObjects, kMaxInstanced) are checked by load_scene() in core/load. A server may set
// lower limits.
inline constexpr int kMaxImageSide = 4096;                   // pixels
inline constexpr std::int64_t kMaxImagePixels = 16'777'216;  // follows from kMaxImageSide
inline constexpr double kMinSize = 1e-90;  // diagonal of a primitive, metres; its cube does not underflow
inline constexpr int kMaxSamples = 4096;   // per pixel
inline constexpr int kMaxDepth = kMaxRayDepth;
inline constexpr int kMaxReuse = 64;                   // paths per group
inline constexpr double kMinTessellationError = 0.01;  // pixels
inline constexpr double kMaxBudgetSeconds = 3600;
inline constexpr int kMaxLights = 1024;
inline constexpr int kMaxTextures = 256;
inline constexpr std::size_t kMaxTextureTexels = 536'870'912;  // sum of all textures; a texel takes 16 bytes
inline constexpr int kMaxObjects = 1'000'000;             // objects of a scene, objects of a model, instances
inline constexpr std::size_t kMaxInstanced = 20'000'000;  // sum of the primitives of all instances
inline constexpr std::int64_t kMaxSeed = std::int64_t{1} << 53;
inline constexpr double kMaxOrbitDegrees = 1e9;
// Factors on the distance of the scene's camera from its target.
inline constexpr double kMinOrbitDistance = 1e-3, kMaxOrbitDistance = 1e3;

}  // namespace orrery
