#pragma once

#include <vector>

#include "core/lighting/random_walk.h"
#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// Finds the bodies that contain points. Not thread-safe: each object owns its batches.
template <class T>
class MediaProbe {
 public:
  // Geometry and accelerator must outlive this object.
  MediaProbe(const Geometry<T>& geometry, const Accelerator<T>& accelerator);

  // Sets `lists` to the bodies that contain the origins of the active rays of `groups`. A body contains a
  // point if a ray from there leaves it before entering it. Bodies that the ray leaves earlier count as
  // entered later. The rays have a fixed direction, and a second one against it if some body is a half-space.
  // Calls checkpoint().
  void find(const LaneGroups& groups, MediaLists& lists, TraceCounts& counts);

  // Returns whether the body contains the point at this fraction of the exposure. REQUIRES: the body is a
  // single shape outside instances.
  bool inside(std::int32_t body, const Vec3<T>& point, T time, TraceCounts& counts);

  RayBatch<T> rays;  // the caller sets origin, t_max and, if something moves, time

 private:
  void follow(const Vec3<T>& direction, const LaneGroups& groups, TraceCounts& counts);
  void record(const LaneGroups& groups);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Media& media_;
  bool has_half_spaces_ = false;
  RayBatch<T> sent_;
  HitBatch<T> hits_;
  SurfaceBatch<T> surface_;
  std::vector<std::vector<std::int32_t>> seen_, inside_;  // by ray: bodies in the order of first crossings
};

// Follows the bodies around the rays of a batch, in scenes with Media::nested(). Not thread-safe.
template <class T>
class MediaStage {
 public:
  MediaStage(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan);

  // Sets PathBatch::media of camera rays.
  void start(PathBatch<T>& camera, TraceCounts& counts);

  // Moves the rays of `groups` through surfaces between equal media, and through surfaces inside a body of
  // higher priority, to the first other surface. Multiplies throughputs by the transmittance of all media on
  // the way, and sets SurfaceBatch::relative_index. Rays without a hit keep their throughput. With
  // Plan::scatters, rays follow a RandomWalk inside media that scatter. REQUIRES: the result of
  // find_surfaces() for these rays. Returns the registers with a surface. Densities of rays that pass
  // surfaces become 0, as for specular directions, because shadow rays do not pass them.
  LaneGroups pass(PathBatch<T>& paths, const LaneGroups& groups, const PathDraws<T>& draws, HitBatch<T>& hits,
                  SurfaceBatch<T>& surface, Vec3Array<T>& radiance, TraceCounts& counts);

  // Calls omit(lane, throughput) for the rays that the last call of pass() ended after kMaxScatterings
  // events.
  template <class Omit>
  void for_each_omitted(const Omit& omit) const {
    if (!walk_) return;
    for (const auto& [lane, throughput] : walk_->omitted()) omit(lane, throughput);
  }

  // Sets the media of the rays that the last append() to `into` added: those of the parent rays in register i
  // of `paths`, or the media behind their surfaces in the lanes `crosses`. `bits` is the result of append().
  void inherit(const PathBatch<T>& paths, int i, const MaskOf<Lanes<T>>& crosses, unsigned bits,
               PathBatch<T>& into) const;

 private:
  using N = Lanes<T>;

  double index_of(const MediaList& list) const {
    const std::int32_t top = list.top(media_.bodies);
    return top < 0 ? 1 : media_.bodies[static_cast<std::size_t>(top)].ior;
  }
  // Scatters the rays of `groups` that are not settled and inside media that scatter.
  void walk(PathBatch<T>& paths, const LaneGroups& groups, const PathDraws<T>& draws, HitBatch<T>& hits,
            SurfaceBatch<T>& surface, Vec3Array<T>& radiance, TraceCounts& counts);
  // Attenuates the ray in `lane` and sets the media behind its surface. Returns true if the ray enters or
  // leaves a body.
  bool cross(PathBatch<T>& paths, int lane, const HitBatch<T>& hits, const SurfaceBatch<T>& surface);
  void attenuate(PathBatch<T>& paths, int lane, const Medium& medium, T distance) const;
  // Corrects the media behind the surface of a ray by the bodies that may have a face in the same place.
  void find_touching(const PathBatch<T>& paths, int lane, const HitBatch<T>& hits,
                     const SurfaceBatch<T>& surface, TraceCounts& counts);
  // Sets the index of the surface of the ray, or moves the ray beyond it and returns true.
  bool settle_or_pass(PathBatch<T>& paths, int lane, HitBatch<T>& hits, const SurfaceBatch<T>& surface);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  const Media& media_;
  MediaProbe<T> probe_;
  MediaLists behind_;  // by ray: media behind its surface
  Array<T> relative_index_;
  Array<T> passed_;      // metres from the ray's origin to the last surface that it passed
  Vec3Array<T> origin_;  // origins of rays with passed_ > 0
  std::array<bool, kBatchRoom> settled_;
  std::unique_ptr<RandomWalk<T>> walk_;          // null unless Plan::scatters
  std::array<std::int32_t, kBatchRoom> walked_;  // by ray: body whose walk has weighed the way, or -1
};

extern template class MediaProbe<float>;
extern template class MediaProbe<double>;
extern template class MediaStage<float>;
extern template class MediaStage<double>;

}  // namespace orrery
