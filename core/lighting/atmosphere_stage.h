#pragma once

#include "core/lighting/lane_masks.h"
#include "core/model/path.h"
#include "core/model/plan.h"

namespace orrery {

// Applies the atmosphere of the scene to the rays of a batch. Not thread-safe. REQUIRES:
// Geometry::atmosphere.
template <class T>
class AtmosphereStage {
  using N = Lanes<T>;

 public:
  // Geometry and plan must outlive this object.
  AtmosphereStage(const Geometry<T>& geometry, const Plan& plan)
      : geometry_(geometry), plan_(plan), color_(Vec3<T>(geometry.scene->atmosphere->color())) {}

  // Returns the shares of light that arrive, for the rays of register i of the last call of enter() or
  // find().
  N share(int i) const { return share_.at(i); }

  // Sets the shares of `groups`. The share is 1 for rays that missed.
  void find(const RayBatch<T>& rays, int depth, const HitBatch<T>& hits, const LaneGroups& groups) {
    geometry_.atmosphere->transmit(plan_.frame, rays, depth, hits, groups, share_);
    for (const int i : groups) share_.put(i, missed_lanes(hits, i), N(T(1)));
  }

  // Multiplies the throughput of `groups` by the shares, so that rays spawned from the hits are attenuated.
  // There is no atmosphere inside bodies: around rays that know their media, or else before hits on the
  // inside of a material that transmits light.
  void enter(const HitBatch<T>& hits, const SurfaceBatch<T>& surface, const LaneGroups& groups,
             const LaneGroups& met, PathBatch<T>& paths) {
    find(paths.rays, paths.depth, hits, groups);
    if (paths.media) {
      for (const int i : groups)
        for (int lane = i; lane < std::min(i + kWidth<T>, paths.rays.count); ++lane)
          if (!(*paths.media)[static_cast<std::size_t>(lane)].empty()) share_[lane] = 1;
    } else {
      for (const int i : met) {
        const auto inside = lanes_with(geometry_, surface, i, &MaterialTraits::transmits);
        share_.put(i, inside && surface.side.at(i) < N(T(0)), N(T(1)));
      }
    }
    for (const int i : groups) {
      throughput_.put(i, paths.throughput.at(i));
      paths.throughput.put(i, paths.throughput.at(i) * share_.at(i));
    }
  }

  // Restores the throughput of `groups`, attenuates their radiance and adds that of the atmosphere.
  void leave(const LaneGroups& groups, PathBatch<T>& paths, Vec3Array<T>& radiance) const {
    for (const int i : groups) {
      const N share = share_.at(i);
      radiance.put(i, radiance.at(i) * share + color_ * (N(T(1)) - share));
      paths.throughput.put(i, throughput_.at(i));
    }
  }

 private:
  const Geometry<T>& geometry_;
  const Plan& plan_;
  const Vec3<N> color_;
  Array<T> share_;
  Vec3Array<T> throughput_;
};

}  // namespace orrery
