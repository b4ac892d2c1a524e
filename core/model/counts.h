#pragma once

#include <array>
#include <cstdint>

#include "core/model/accelerator.h"

namespace orrery {

inline constexpr int kMaxRayDepth = 32;  // largest max_depth that a request or scene may set

// Ray counts by kind and depth. The depth of a shadow ray is the depth of the ray at whose hit the shadow ray
// starts.
struct RayCounts {
  using ByDepth = std::array<std::uint64_t, kMaxRayDepth + 1>;
  std::uint64_t camera = 0;
  ByDepth reflected{}, refracted{}, shadow{};

  std::uint64_t total() const {
    std::uint64_t sum = camera;
    for (std::size_t d = 0; d < reflected.size(); ++d) sum += reflected[d] + refracted[d] + shadow[d];
    return sum;
  }
  void add(const RayCounts& other) {
    camera += other.camera;
    for (std::size_t d = 0; d < reflected.size(); ++d) {
      reflected[d] += other.reflected[d];
      refracted[d] += other.refracted[d];
      shadow[d] += other.shadow[d];
    }
  }
};

// Counters of one part of a render.
struct TraceCounts {
  RayCounts rays;
  AcceleratorCounts accelerator;
  std::uint64_t camera_hits = 0;  // camera rays that hit something
  std::uint64_t cut_rays = 0;     // rays not traced because of depth, throughput or technique

  void add(const TraceCounts& other) {
    rays.add(other.rays);
    accelerator.add(other.accelerator);
    camera_hits += other.camera_hits;
    cut_rays += other.cut_rays;
  }
};

}  // namespace orrery
