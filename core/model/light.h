#pragma once

#include <memory>

#include "core/model/draws.h"
#include "core/model/rounding.h"

// Lights. A scene stores all lights of one type in a LightSet, in double precision. Each set creates a
// LightKernel in the plan's number type. Kernel functions process whole batches.
//
// Convention: a white Lambert surface that faces a light of intensity 1 has radiance 1.
namespace orrery {

class Params;

// Incident light at every surface point of a batch.
template <class T>
struct LightBatch {
  // Shadow rays. The kernel sets the unit direction toward the light and t_max: metres to the light, infinity
  // if directional, or -1 if no light arrives. The caller sets the origins afterwards, on the side of the
  // surface that the light comes from.
  RayBatch<T> shadow;
  // Factor of pi_bsdf_cos in the reflected radiance, per channel. Lights with a positive pdf: radiance
  // divided by pi and by pdf. Other lights: intensity after attenuation and cone, divided by the selection
  // probability.
  Vec3Array<T> incident;
  // Sampling density per solid angle times the selection probability, or 0 for lights that no ray can hit.
  Array<T> pdf;
};

// Light of a kernel, chosen for a whole batch, and the probability of the choice.
template <class T>
struct LightChoice {
  int index;  // index of the light in the kernel
  T probability = 1;
};

// Light of a kernel for each lane, and the probability of the choice. The index is -1 in lanes without a
// light.
template <class T>
struct LightChoices {
  Array<IndexOf<T>> index;
  Array<T> probability;
};

// Light sampling for all lights of one type. Immutable and thread-safe.
template <class T>
class LightKernel {
 public:
  virtual ~LightKernel() = default;

  // Evaluates one light at every surface point of `groups`: sets direction, t_max and incident. Lights of a
  // LightSet count as one point or direction. sample_each() could replace this function, but techniques that
  // evaluate every light would then be 2.5 % slower.
  virtual void sample(const SurfaceBatch<T>& surface, const LightChoice<T>& choice, const PathDraws<T>& draws,
                      const LaneGroups& groups, LightBatch<T>& out) const = 0;

  // Samples a point or direction on the light that `choices` assigns to each lane: sets direction, t_max,
  // incident and pdf. Sets only the lanes that have a light.
  virtual void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices,
                           const PathDraws<T>& draws, const LaneGroups& groups, LightBatch<T>& out) const = 0;

  // Computes LightBatch::pdf of sample_each() for the directions of `rays`, which hit the lights at `hits`.
  // Sets at least the lanes that have a light. The result is 0 for lights that no ray can hit.
  virtual void pdf(const RayBatch<T>& /*rays*/, const HitBatch<T>& /*hits*/,
                   const LightChoices<T>& /*choices*/, const LaneGroups& groups, Array<T>& out) const {
    for (const int i : groups) out.put(i, Lanes<T>(T(0)));
  }

  // Computes the radiance that `rays`, which miss everything, receive from an extended light at infinity.
  // `pdf` is LightBatch::pdf of sample_each() for the directions of `rays`. Both are 0 for other lights.
  virtual void beyond(const RayBatch<T>& /*rays*/, const LightChoice<T>& /*choice*/, const LaneGroups& groups,
                      Vec3Array<T>& radiance, Array<T>& pdf) const {
    for (const int i : groups) {
      radiance.put(i, Vec3<Lanes<T>>(Lanes<T>(T(0))));
      pdf.put(i, Lanes<T>(T(0)));
    }
  }
};
template <class T>
using LightKernelPtr = std::unique_ptr<LightKernel<T>>;

// Properties of a light type that the plan uses.
struct LightTraits {
  bool delta = true;      // no ray can hit a light of this type; only light sampling finds it
  bool parallel = false;  // infinitely distant: the same direction everywhere
};

// Parameters of a rough estimate of the unshadowed light at a point, for light selection. A white surface
// that faces the light, d metres from the centre, has radiance strength * min(1, 1 / (c0 + c1 d + c2 d^2)).
// The estimate is never 0 at a point that the light reaches.
struct LightBounds {
  Vec3d centre{};
  double radius = 0;  // radius of the bounding sphere about `centre`, metres
  // Unit normal of a flat light, which emits on both sides in proportion to the cosine. The zero vector for
  // lights that emit in all directions.
  Vec3d normal{};
  double strength = 0;         // in the brightest channel
  Vec3d attenuation{1, 0, 0};  // c0, c1, c2
  bool parallel = false;       // infinitely far away
};

// All lights of one type. add() is called by one thread while the scene is loaded, and records problems in
// `params`. The other functions are thread-safe afterwards.
class LightSet {
 public:
  virtual ~LightSet() = default;
  virtual void add(Params& params) = 0;
  virtual int size() const = 0;
  virtual LightTraits traits() const = 0;
  virtual Vec3d intensity(int index) const = 0;  // before attenuation, per channel
  virtual LightBounds bounds(int index) const = 0;
  // Returns an upper bound on LightBatch::incident at `distance` metres or more from the centre of the
  // bounds, per channel. The light counts as one point or direction. The result is infinite if there is no
  // bound.
  virtual Vec3d max_incident(int index, double distance) const = 0;
  // Returns the largest radiance that the light adds to rays that miss everything, per channel.
  virtual Vec3d max_radiance_at_infinity(int /*index*/) const { return Vec3d(0); }
  virtual RoundingLimit rounding(int /*index*/) const { return {}; }
  // Returns true if sample_each() samples points or directions over the extent of the light. sample() always
  // treats the light as one point or direction.
  virtual bool extended(int /*index*/) const { return false; }
  virtual LightKernelPtr<float> kernel(float) const = 0;
  virtual LightKernelPtr<double> kernel(double) const = 0;
};

// Location of a light in a scene: the index of its type in the registry, and its index within the set.
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
