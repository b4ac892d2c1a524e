#pragma once

#include <memory>

#include "core/model/draws.h"
#include "core/model/rounding.h"

// Lights. As with shapes, a scene keeps all lights of one type together (a LightSet, in double precision) and
// makes a kernel of them in the plan's number type, whose calls take whole batches.
//
// Convention: a white Lambert surface that faces a light of intensity 1 reads 1.
namespace orrery {

class Params;

// Light as it arrives at every surface point of a batch.
template <class T>
struct LightBatch {
  // Rays that ask whether the light is seen. The light fills the unit direction toward it and t_max (metres
  // to it, infinite if it is directional, -1 if it sends nothing here). Their origins are set once the
  // direction is known: on the side of the surface that the light comes from.
  RayBatch<T> shadow;
  // Radiance times cosine at the light over the density with which it was drawn and the probability of the
  // choice; of a light that is one point, its intensity after attenuation and cone.
  // (Area lights: radiance over pi and the density, so that a white Lambert surface reflects as much.)
  Vec3Array<T> incident;
  // Density per solid angle with which the direction was drawn, times the probability of the choice; 0 of a
  // light that no ray can hit.
  Array<T> pdf;
};

// Which light of a kernel a batch asks, and the probability with which it was chosen.
template <class T>
struct LightChoice {
  int index;  // within the kernel
  T probability = 1;
};

// One of a kernel's lights for each lane, or -1 for none, and the probability with which it was chosen.
template <class T>
struct LightChoices {
  Array<IndexOf<T>> index;
  Array<T> probability;
};

// Const and free of state: any number of threads may call it at once.
template <class T>
class LightKernel {
 public:
  virtual ~LightKernel() = default;

  // Draws a point of the light for every surface point of `groups`: fills direction, t_max and incident. (As
  // sample_each() of one light for all would: where each light is asked, that takes 2.5 % more of a picture.)
  virtual void sample(const SurfaceBatch<T>& surface, const LightChoice<T>& choice, const PathDraws<T>& draws,
                      const Groups& groups, LightBatch<T>& out) const = 0;

  // Likewise, each surface point of another light: fills the lanes that have one, and pdf.
  virtual void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices,
                           const PathDraws<T>& draws, const Groups& groups, LightBatch<T>& out) const = 0;

  // Density per solid angle, times the probability of the choice, with which sample_each() draws the
  // directions of `rays`, which hit the lights at `hits`, from where they start. Fills the lanes that have a
  // light; 0 of a light that no ray can hit.
  virtual void pdf(const RayBatch<T>& /*rays*/, const HitBatch<T>& /*hits*/,
                   const LightChoices<T>& /*choices*/, const Groups& groups, Array<T>& out) const {
    for (const int i : groups) out.put(i, Lanes<T>(T(0)));
  }

  // Of a light that is infinitely far away and has an angle: the radiance that `rays` bring from it where
  // they meet nothing, and the density per solid angle, times the probability of the choice, with which
  // sample_each() draws their directions.
  virtual void beyond(const RayBatch<T>& /*rays*/, const LightChoice<T>& /*choice*/, const Groups& groups,
                      Vec3Array<T>& radiance, Array<T>& pdf) const {
    for (const int i : groups) {
      radiance.put(i, Vec3<Lanes<T>>(Lanes<T>(T(0))));
      pdf.put(i, Lanes<T>(T(0)));
    }
  }
};
template <class T>
using LightKernelPtr = std::unique_ptr<LightKernel<T>>;

// What the plan may use about a type of light.
struct LightTraits {
  bool delta = true;      // no ray can hit it: only sample() finds it
  bool parallel = false;  // the same direction everywhere
};

// How much of a light reaches a point, roughly, unshadowed: by which lights are chosen. A white surface that
// faces the light d metres from the centre, in front of it, reads strength * min(1, 1 / (c0 + c1 d + c2
// d^2)). A light that reaches a point at all has no estimate of 0 there.
struct LightBounds {
  Vec3d centre{};
  double radius = 0;  // metres; a sphere about the centre holds the light
  // Unit normal of a flat light, which shines on both sides with the cosine; 0 of one that shines everywhere.
  Vec3d normal{};
  double strength = 0;         // in the brightest channel
  Vec3d attenuation{1, 0, 0};  // c0, c1, c2
  bool parallel = false;       // infinitely far away
};

class LightSet {
 public:
  virtual ~LightSet() = default;
  virtual void add(Params& params) = 0;
  virtual int size() const = 0;
  virtual LightTraits traits() const = 0;
  virtual Vec3d intensity(int index) const = 0;  // at the source, per channel
  virtual LightBounds bounds(int index) const = 0;
  // The most that reaches points so many metres from the centre of the bounds, or more, taken for one point
  // or direction, per channel: LightBatch::incident. Infinite where nothing limits it.
  virtual Vec3d most_at(int index, double distance) const = 0;
  // The largest radiance that rays which meet nothing may bring from it.
  virtual Vec3d most_seen(int /*index*/) const { return Vec3d(0); }
  virtual RoundingLimit rounding(int /*index*/) const { return {}; }
  // Whether sample_each() draws from an extent of the light that sample() takes for one point or direction.
  virtual bool extended(int /*index*/) const { return false; }
  virtual LightKernelPtr<float> kernel(float) const = 0;
  virtual LightKernelPtr<double> kernel(double) const = 0;
};

// One light of a scene: a type's place in the registry and its number within the set.
struct LightPlace {
  std::size_t set;
  int index;
};

struct LightType {
  const char* name;
  const char* summary;
  std::unique_ptr<LightSet> (*make)();
};

}  // namespace orrery
