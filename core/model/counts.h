#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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

// Energy account of one material: light that arrives at its surfaces against the direction of the traced
// rays, one unit per hit, and the parts that diffuse lobes reflect, that other lobes reflect, and that is
// transmitted, as means over the channels. The rest is absorbed. Sums are integers, so that they do not
// depend on the order of additions.
struct EnergySums {
  static constexpr double kUnit = 1.0 / (1 << 24);

  std::uint64_t hits = 0;
  std::int64_t diffuse = 0, specular = 0, transmitted = 0;  // in multiples of kUnit

  static std::int64_t rounded(double share) { return std::llround(share / kUnit); }
  // Returns the mean of a sum, per hit. REQUIRES: hits > 0.
  double mean(std::int64_t sum) const { return static_cast<double>(sum) * kUnit / static_cast<double>(hits); }
  // Returns the mean absorbed share. It is negative if the material creates energy.
  double absorbed() const { return 1 - mean(diffuse + specular + transmitted); }

  void add(const EnergySums& other) {
    hits += other.hits;
    diffuse += other.diffuse;
    specular += other.specular;
    transmitted += other.transmitted;
  }
};

// Counters of one part of a render.
struct TraceCounts {
  RayCounts rays;
  AcceleratorCounts accelerator;
  std::uint64_t camera_hits = 0;   // camera rays that hit something
  std::uint64_t cut_rays = 0;      // rays not traced because of depth, throughput or technique
  std::uint64_t scatterings = 0;   // scattering events inside media
  std::vector<EnergySums> energy;  // by material; empty unless Plan::energy_of is set

  void add(const TraceCounts& other) {
    rays.add(other.rays);
    accelerator.add(other.accelerator);
    camera_hits += other.camera_hits;
    cut_rays += other.cut_rays;
    scatterings += other.scatterings;
    if (energy.size() < other.energy.size()) energy.resize(other.energy.size());
    for (std::size_t i = 0; i < other.energy.size(); ++i) energy[i].add(other.energy[i]);
  }
};

}  // namespace orrery
