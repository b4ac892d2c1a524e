#pragma once

#include <numbers>

#include "core/materials/material_set.h"
#include "core/materials/shading_frame.h"

namespace orrery {

// Result of MaterialKernel::evaluate() for one direction of light.
template <class N>
struct Scattered {
  Vec3<N> pi_bsdf_cos;
  N pdf;
};

// Sampled direction in ShadingFrame coordinates. In the lanes `through`, the direction leaves on the far side
// of the surface.
template <class N>
struct DrawnDirection {
  Vec3<N> direction;
  MaskOf<N> through;
};

// Random numbers in [0, 1) for sampling a direction. `side` decides between reflection and transmission.
template <class N>
struct LobeDraw {
  N u, v, side;

  // Result of choose(). `first` are the lanes where u < `share`. `u` is the random number rescaled to [0, 1)
  // within the chosen part, so that it can be used again.
  struct Choice {
    MaskOf<N> first;
    N u;
  };
  Choice choose(const N& share) const {
    using T = ScalarOf<N>;
    const N one(T(1)), last(T(1) - std::numeric_limits<T>::epsilon() / 2);
    const auto first = u < share;
    return {first, min_first(last, select(first, N(u / share), N((u - share) / (one - share))))};
  }
};

// Returns the probability of sampling a lobe of albedo `own` rather than a lobe of albedo `other`. Returns 1
// if `other` is 0, 0 if only `own` is 0, and otherwise a value in [0.05, 0.95].
template <class N>
[[gnu::always_inline]] inline N lobe_chance(const N& own, const N& other) {
  using T = ScalarOf<N>;
  const N zero(T(0)), one(T(1)), sum = own + other;
  const N chance = min_first(N(T(0.95)), max_first(N(T(0.05)), N(own / select(sum > zero, sum, one))));
  return select(other > zero, select(own > zero, chance, zero), one);
}

// Kernel of materials whose scattering depends on both directions. In addition to the members listed in
// material_set.h, a record has the following members. Directions are in ShadingFrame coordinates, with the
// viewer above the surface.
//   N rough() const                                           0: only specular; the derived kernel samples it
//   Vec3<N> ambient_reflectance(cosine, lobes) const          fraction of ambient light sent to the viewer
//   Scattered<N> scattered(viewer, light, inside, lobes)      value and density for light on either side
//   DrawnDirection<N> drawn(viewer, inside, lobes, LobeDraw)  direction with the density of scattered()
//   Vec3<N> body_transmittance(inside, travelled)             transmittance of `travelled` metres inside
template <template <class> class Record, class T>
class LobeKernel : public MaterialRecords<Record, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Record, T>::MaterialRecords;

  void ambient(const RayBatch<T>& rays, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const Vec3<N> ambient_reflectance(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const Vec3<N> viewer = -rays.direction.at(i);
      const ShadingFrame<N> frame(surface.normal.at(i), surface.geometric.at(i), viewer);
      radiance.put(i, mine,
                   record.ambient_reflectance(dot(frame.normal, viewer), lobes) * ambient_reflectance);
    });
  }

  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const Vec3<N> geometric = surface.geometric.at(i), light = directions.light.at(i);
      const Vec3<N> viewer = -directions.ray.at(i);
      const ShadingFrame<N> frame(surface.normal.at(i), geometric, viewer);
      const Vec3<N> local_viewer = frame.local(viewer), local_light = frame.local(light);
      const auto lit = mine && record.rough() > zero && directions.reach.at(i) > zero &&
                       on_one_side(local_viewer, local_light, directions.side_cosine(surface, i));
      pdf.put(i, mine, zero);
      if (!any(lit)) return;
      const auto inside = surface.side.at(i) < zero;
      const auto& between = between_media(record, surface, i);
      const auto scattered = between.scattered(local_viewer, local_light, inside, lobes);
      pi_bsdf_cos.put(i, lit,
                      scattered.pi_bsdf_cos * between.body_transmittance(inside, surface.travelled.at(i)));
      pdf.put(i, lit, scattered.pdf);
    });
  }

  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Record<N>& record) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const N side = draws.two(SampleSet::survival, i).v;
      sample_rough(rays, surface, i, mine && record.rough() > zero, record, lobes, {u, v, side}, out);
    });
  }

 protected:
  // Samples the `lobes` of the record. Sets the lanes `mine` of `out`.
  void sample_rough(const RayBatch<T>& rays, const SurfaceBatch<T>& surface, int i, const MaskOf<N>& mine,
                    const Record<N>& alone, Lobes lobes, const LobeDraw<N>& draw,
                    ScatterBatch<T>& out) const {
    if (!any(mine)) return;
    const auto& record = between_media(alone, surface, i);
    const N zero(T(0));
    const Vec3<N> viewer = -rays.direction.at(i), geometric = surface.geometric.at(i);
    const auto inside = surface.side.at(i) < zero;
    const ShadingFrame<N> frame(surface.normal.at(i), geometric, viewer);
    const Vec3<N> local_viewer = frame.local(viewer);
    const auto drawn = record.drawn(local_viewer, inside, lobes, draw);
    const Vec3<N> light = normalize(frame.world(drawn.direction)), local_light = frame.local(light);
    const auto scattered = record.scattered(local_viewer, local_light, inside, lobes);
    const auto leaves = mine && on_one_side(local_viewer, local_light, dot(geometric, light)) &&
                        (local_light.z < zero) == drawn.through && scattered.pdf > zero;
    constexpr T kPi = std::numbers::pi_v<T>;  // pi_bsdf_cos contains a factor pi: see MaterialKernel
    const Vec3<N> share = scattered.pi_bsdf_cos * record.body_transmittance(inside, surface.travelled.at(i));
    out.direction.put(i, mine, select(leaves, light, geometric));
    out.weight.put(i, mine, Vec3<N>(zero));
    out.weight.put(i, leaves, share * (N(T(1)) / (kPi * scattered.pdf)));
    out.pdf.put(i, mine, select(leaves, scattered.pdf, zero));
  }

 private:
  // Returns the record, adapted to the media on both sides of the surfaces if it has a medium.
  static decltype(auto) between_media(const Record<N>& record, const SurfaceBatch<T>& surface, int i) {
    if constexpr (requires { record.between_media(surface, i); })
      return record.between_media(surface, i);
    else
      return (record);
  }
  // Returns the lanes where the viewer is above the shading surface, and the light is on the same side of the
  // shading and the geometric surface.
  static MaskOf<N> on_one_side(const Vec3<N>& local_viewer, const Vec3<N>& local_light,
                               const N& true_cosine) {
    return local_viewer.z > N(T(0)) && local_light.z * true_cosine > N(T(0));
  }
};

}  // namespace orrery
