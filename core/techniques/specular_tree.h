#pragma once

#include "core/lighting/direct_light.h"
#include "core/lighting/environment_lighting.h"
#include "core/lighting/lane_masks.h"
#include "core/techniques/wavefront.h"

namespace orrery {

// Base of techniques that add ambient light and the direct light of every source, and follow perfectly
// specular directions only.
template <class T>
class SpecularTree : public Wavefront<T> {
 public:
  using N = Lanes<T>;
  using Kind = typename Wavefront<T>::Kind;

  SpecularTree(const World<T>& world, const Plan& plan);

 protected:
  // Continues paths at specular surfaces: calls follow() or cut() for the specular lanes of each register of
  // `groups`. REQUIRES: each of these registers has a specular surface.
  virtual void scatter(const LaneGroups& groups) = 0;

  // Spawns rays from the surfaces in the lanes `mask` of register i along `direction`, with `weight` per
  // channel. Cuts rays beyond Plan::max_depth, and rays whose throughput is below Plan::min_contribution in
  // every channel.
  void follow(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& weight);
  // Adds ambient light in place of untraced rays along `direction`, and records the rays as omitted.
  void cut(int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& weight);
  // Adds ambient light in place of untraced rays.
  void add_ambient(int i, const MaskOf<N>& mask, const Vec3<N>& weight);
  void shade(const LaneGroups& groups, const LaneGroups& met) final;
  // Sets the radiance of the surfaces of `met`.
  virtual void shade_surfaces(const LaneGroups& met);
  // Returns the lanes of register i whose material is specular.
  MaskOf<N> specular_lanes(int i) const {
    return lanes_with(this->geometry_, this->vertices_->surface, i, &MaterialTraits::mirrors);
  }

  SpecularBatch<T> specular_;

 private:
  DirectLight<T> direct_light_;
  EnvironmentLighting<T> environment_lighting_;
};

extern template class SpecularTree<float>;
extern template class SpecularTree<double>;

}  // namespace orrery
