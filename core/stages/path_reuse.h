#pragma once

#include <vector>

#include "core/base/checkpoint.h"
#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/model/record.h"
#include "core/model/world.h"

namespace orrery {

template <class N>
struct SecondVertex {
  Vec3<N> position, geometric;
  N step;
  N shared;  // 1, or 0: nothing may be connected to it
};

// What a second vertex receives, and one over the density with which its group draws it; 0: nobody does.
template <class N>
struct Arrival {
  Vec3<N> suffix;
  N inverse_density;
};

// Paths of one tile that share what their second vertices receive: each first vertex is connected to the
// second vertices of a group of others, which are drawn anew for each sample, and weighted with the densities
// with which all of the group could have found them (Bekaert, Sbert, Halton, "Accelerating Path Tracing by
// Re-Using Paths", EGWR 2002; balance heuristic, with every visibility traced, so that nothing is biased).
// One object belongs to one thread: it keeps its batches.
template <class T>
class PathReuse {
 public:
  // Geometry, accelerator and plan outlive it.
  // REQUIRES: plan.reuse divides kBatch.
  PathReuse(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan);

  // Before a batch of camera rays.
  void begin(const Draws& draws);

  // The first vertices of register i, where slots are places in the batch: the weight and the density of the
  // direction that was drawn. `drawn`: lanes whose direction others could draw; `alive`: lanes whose path
  // goes on, with a throughput of 1 from there; `lit`: lanes that others may be connected to, whatever became
  // of their own draw.
  void keep_first(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                  const ScatterBatch<T>& scatter, const MaskOf<Lanes<T>>& alive,
                  const MaskOf<Lanes<T>>& drawn, const MaskOf<Lanes<T>>& lit);
  // The second vertices of register i that look the same from everywhere.
  void keep_second(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                   const MaskOf<Lanes<T>>& shared);

  // Sums by slot of what reaches the second vertices, for throughputs that start at 1 there.
  Vec3Array<T>& suffixes() { return suffix_; }
  // Weight of the first direction of each slot.
  const Vec3Array<T>& weights() const { return weight_; }

  // Adds what the first vertices get from there to the radiance of the slots. False once the work is to end.
  bool finish(Vec3Array<T>& radiance, TraceCounts& counts, const Checkpoint& checkpoint);

 private:
  using N = Lanes<T>;
  struct Connections {
    Array<T> density;    // area density with which the slot's first vertex draws its partner's second vertex
    Vec3Array<T> share;  // of what leaves that and reaches the slot, per area
  };
  void connect_own(Connections& own);
  void connect(int turn, Connections& to, TraceCounts& counts);
  void aim(int turn);
  void find_arrivals();
  Vec3<N> received(int i) const;

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const int group_;
  const Groups all_ = Groups::covering(0, kBatch, kWidth<T>);
  Groups kept_;  // registers that have first vertices
  // By turn and slot: the one of its group that it is connected to; at turn 0 itself.
  std::vector<Array<IndexOf<T>>> partners_;
  // First vertices by slot.
  SurfaceBatch<T> first_;
  Vec3Array<T> ray_, weight_;
  Array<T> pdf_;                         // 0: no other could draw the direction
  Array<T> lit_;                         // 1 or 0
  std::vector<SecondVertex<T>> second_;  // by slot
  Vec3Array<T> suffix_;
  std::vector<Arrival<T>> arrivals_;  // by slot
  // One turn of connections.
  Vec3Array<T> toward_normal_, f_cos_;
  Array<T> lobe_pdf_;
  RayBatch<T> shadow_;
  std::vector<Connections> connections_;  // by turn
};

extern template class PathReuse<float>;
extern template class PathReuse<double>;

}  // namespace orrery
