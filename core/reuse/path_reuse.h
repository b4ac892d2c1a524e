#pragma once

#include <vector>

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
  N shared;  // 1 if paths may connect to the vertex, else 0
};

// Radiance that a second vertex reflects, and the inverse of the density per area with which the paths of the
// group sample the vertex. The inverse is 0 if only the path of the vertex can reach it.
template <class N>
struct Arrival {
  Vec3<N> suffix;
  N inverse_density;
};

// Path reuse within a tile. Each first vertex is connected to the second vertices of a random group of paths.
// The groups are different for each sample. Contributions are weighted with the densities of the whole group
// (Bekaert, Sbert, Halton, "Accelerating Path Tracing by Re-Using Paths", EGWR 2002). The balance heuristic
// and traced visibility keep the result unbiased. Not thread-safe: each object owns its batches.
template <class T>
class PathReuse {
 public:
  // Geometry, accelerator and plan must outlive this object. REQUIRES: plan.reuse divides kBatch.
  PathReuse(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan);

  // Starts a batch of camera rays.
  void begin(const Draws& draws);

  // Stores the first vertices of register i, with weight and density of the sampled direction. REQUIRES:
  // `paths` are the camera rays. `drawn`: lanes whose direction other paths can sample. `alive`: lanes whose
  // path continues, with a throughput of 1 after the vertex. `lit`: lanes that may connect to second vertices
  // of other paths, even if their own sample failed.
  void keep_first(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                  const ScatterBatch<T>& scatter, const MaskOf<Lanes<T>>& alive,
                  const MaskOf<Lanes<T>>& drawn, const MaskOf<Lanes<T>>& lit);
  // Stores the second vertices of register i for the lanes `shared`, whose reflected light is the same in all
  // directions.
  void keep_second(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                   const MaskOf<Lanes<T>>& shared);

  // Returns sums of the radiance that second vertices reflect to first vertices, by camera ray. The
  // throughput of contributions starts with 1 at the second vertex.
  Vec3Array<T>& suffixes() { return suffix_; }
  // Returns the weight of the direction sampled at the first vertex, by camera ray.
  const Vec3Array<T>& weights() const { return weight_; }

  // Adds the light that first vertices reflect from second vertices to `radiance`, by camera ray. Calls
  // checkpoint().
  void finish(Vec3Array<T>& radiance, TraceCounts& counts);

 private:
  using N = Lanes<T>;
  struct Connections {
    Array<T> density;    // per area: this first vertex samples the second vertex of the partner
    Vec3Array<T> share;  // factor from the radiance of that vertex to the camera ray, per area
  };
  void connect_own(Connections& own);
  void connect(int turn, Connections& to, TraceCounts& counts);
  void aim(int turn);
  void find_arrivals();
  Vec3<N> received(int i) const;

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const int group_;
  const LaneGroups all_ = LaneGroups::covering(0, kBatch, kWidth<T>);
  LaneGroups kept_;  // registers with first vertices
  // Partner of each camera ray in its group, by turn. At turn 0, every camera ray is its own partner.
  std::vector<Array<IndexOf<T>>> partners_;
  // First vertices by camera ray.
  SurfaceBatch<T> first_;
  Vec3Array<T> ray_, weight_;
  Array<T> pdf_;                         // per solid angle; 0: other paths cannot sample the direction
  Array<T> lit_;                         // 1 or 0: see keep_first()
  std::vector<SecondVertex<T>> second_;  // by camera ray
  Vec3Array<T> suffix_;
  std::vector<Arrival<T>> arrivals_;  // by camera ray
  // Temporaries of one turn.
  Vec3Array<T> toward_normal_, f_cos_;
  Array<T> lobe_pdf_;
  RayBatch<T> shadow_;
  std::vector<Connections> connections_;  // by turn
};

extern template class PathReuse<float>;
extern template class PathReuse<double>;

}  // namespace orrery
