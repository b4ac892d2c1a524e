#pragma once

#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// Follows rays inside media that scatter light, from event to event. Not thread-safe: each object owns its
// batches.
//
// The distance to the next event is sampled for one channel, chosen in proportion to the throughput of the
// channels. The weight is that of the balance heuristic over the channels (Chiang, Kutz, Burley, "Practical
// and Controllable Subsurface Scattering for Production Path Tracing", SIGGRAPH Talks 2016). The sum of the
// throughput over the channels therefore never grows, except by Russian roulette. Directions are sampled from
// the phase function itself. Russian roulette is that of PathTracer.
template <class T>
class RandomWalk {
 public:
  // Geometry, accelerator and plan must outlive this object.
  RandomWalk(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan);

  // Forgets the events of earlier calls of run(), for the rays of `groups`, and clears omitted().
  void start(const LaneGroups& groups);
  // Adds the ray in `lane`, which is inside `body`, to the next call of run().
  void add(const PathBatch<T>& paths, int lane, const HitBatch<T>& hits, std::int32_t body);
  bool empty() const { return rays_.count == 0; }

  // Moves the added rays to the last event before they leave their medium or hit a surface, and multiplies
  // their throughput by the weights of the way to that hit. The density of rays with an event becomes 0,
  // because shadow rays do not reach events. Rays that are absorbed, or omitted after kMaxScatterings events,
  // lose their hit, and their throughput becomes 0. Calls checkpoint(). REQUIRES: `hits` has the nearest hit
  // of each ray.
  void run(PathBatch<T>& paths, const PathDraws<T>& draws, HitBatch<T>& hits, TraceCounts& counts);

  // Returns the rays with an event in the last call of run().
  const std::vector<int>& moved() const { return moved_; }

  struct Omitted {
    int lane;
    Vec3<T> throughput;
  };
  // Returns the omitted rays of all calls of run() since start().
  const std::vector<Omitted>& omitted() const { return omitted_; }

 private:
  using N = Lanes<T>;

  // Returns the lanes of register i with a ray.
  MaskOf<N> used_lanes(int i) const {
    const N index([&](auto lane) { return static_cast<T>(i + static_cast<int>(lane)); });
    return index < N(static_cast<T>(rays_.count));
  }
  // Limits the hits of register i to the sampled distance of the next event.
  void sample_distance(int i, const PathDraws<T>& draws, bool known_hits);
  // Multiplies the throughput of register i by the weights of the distance, and returns the lanes with an
  // event.
  MaskOf<N> weigh(int i);
  // Moves the rays in the lanes `scattered` to their events. Returns the lanes that survive.
  MaskOf<N> scatter(int i, const MaskOf<N>& scattered, const PathDraws<T>& draws);
  // Writes the rays of register i that stop here to `paths` and `hits`. Returns the lanes that continue.
  MaskOf<N> finish(int i, const MaskOf<N>& scattered, MaskOf<N> alive, PathBatch<T>& paths, HitBatch<T>& hits,
                   TraceCounts& counts);
  void write_back(int from, bool ended, PathBatch<T>& paths, HitBatch<T>& hits);
  bool strayed(int i) const;
  // Moves the rays of register i in the lanes `mask` to the end of the first `count` rays. Returns the new
  // count.
  int keep(int i, const MaskOf<N>& mask, int count);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  const Media& media_;
  // Rays inside media, densely packed.
  RayBatch<T> rays_;
  HitBatch<T> hits_;
  Vec3Array<T> throughput_;
  Vec3Array<T> rate_;  // binary logarithm of the attenuation per metre
  Vec3Array<T> albedo_;
  Array<T> anisotropy_;
  Array<T> walked_;  // metres
  Array<IndexOf<T>> slot_, lane_, body_, event_;
  Array<IndexOf<T>> events_;  // by ray of the path batch: number of the next event
  std::vector<Omitted> omitted_;
  std::vector<int> moved_;
};

extern template class RandomWalk<float>;
extern template class RandomWalk<double>;

}  // namespace orrery
