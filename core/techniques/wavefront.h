#pragma once

#include <vector>

#include "core/lighting/atmosphere_stage.h"
#include "core/lighting/energy_account.h"
#include "core/lighting/media_stage.h"
#include "core/model/path.h"
#include "core/model/technique.h"

// Main loop of all techniques. Each batch of rays passes as a whole through the stages
//   closest hit -> surface -> atmosphere -> shading (by the technique) -> deposit
// and the rays spawned by shading form the next batches. There is no recursion: batches wait on a stack, at
// most two per depth, so memory is bounded for every scene. The rays of a batch, and therefore the order of
// sums, depend only on the scene and the plan, not on SIMD width, Plan::slice or threads.
namespace orrery {

template <class T>
class Wavefront : public Tracer<T> {
 public:
  using N = Lanes<T>;

  Wavefront(const World<T>& world, const Plan& plan);
  void trace(const RayBatch<T>& camera_rays, const Draws& draws, TraceResult<T>& out,
             TraceCounts& counts) final;

 protected:
  // Rays of the current batch and their hits.
  struct Vertices {
    PathBatch<T>* paths;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
    // Radiance toward each ray's origin. Starts as the background for rays that miss everything, else as 0.
    Vec3Array<T> radiance;
  };

  // Adds the light that leaves surfaces toward the origins of the rays of `groups`, and continues paths by
  // spawn(). `met` are the registers of `groups` with a surface.
  virtual void shade(const LaneGroups& groups, const LaneGroups& met) = 0;

  // Sets the hits and the surfaces of the rays of `groups`. Sets the radiance to the background for rays that
  // miss everything, else to 0. Returns the registers with a surface.
  virtual LaneGroups find_vertices(const LaneGroups& groups);

  // Called before a batch of camera rays, and after all rays spawned from it.
  virtual void begin() {}
  virtual void finish() {}
  // Returns the sums, by camera ray, to which the light of rays of this depth is added.
  virtual Vec3Array<T>& sums(int /*depth*/) { return out_->radiance; }

  enum class Kind { reflected, refracted };
  // Spawns rays from the surfaces in the lanes `mask` of register i along `direction`. `throughput` is
  // PathBatch::throughput of the new rays. Returns the mask as bits.
  unsigned spawn(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction,
                 const Vec3<N>& throughput);
  // Spawns one ray per vertex. `pdf` is the density per solid angle with which the direction of the ray was
  // sampled. The rays count as reflected rays.
  void spawn(int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& throughput, const N& pdf);
  // Records untraced rays with throughput `weight` in the lanes `mask`: adds `weight` times Plan::cut_range
  // to the omitted light of the camera rays, and counts the rays.
  void record_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight);
  // As above, for rays along `direction` from the surfaces of register i. Rays that miss Plan::occupied count
  // with Plan::cut_range_beyond.
  void record_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight, const Vec3<N>& direction);

  // Returns the light removed by clamping, by camera ray.
  Vec3Array<T>& clamped() { return out_->clamped; }

  const Draws& batch_draws() const { return *draws_; }
  PathDraws<T> draws() const { return {*draws_, vertices_->paths->slot, vertices_->paths->depth}; }
  TraceCounts& counts() { return *counts_; }

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  std::unique_ptr<Vertices> vertices_;
  std::unique_ptr<AtmosphereStage<T>> atmosphere_;  // null if the scene has no atmosphere

 private:
  // Adds `weight` times `range` to the omitted light in the lanes `mask` of register i, and counts the rays.
  void add_omitted(int i, const MaskOf<N>& mask, const Vec3<N>& weight, const Vec3d& range);
  void start(const RayBatch<T>& camera_rays);
  void run(PathBatch<T>& paths);
  // Sets the time of each ray to the time of its camera ray.
  void inherit_times(PathBatch<T>& paths) const;
  void run_slice(const LaneGroups& groups);
  void record_channels(const LaneGroups& groups, const LaneGroups& met);
  std::unique_ptr<PathBatch<T>> take_batch(int depth);
  void push(std::unique_ptr<PathBatch<T>> batch);

  std::vector<std::unique_ptr<PathBatch<T>>> waiting_, spare_;
  std::unique_ptr<PathBatch<T>> reflected_, refracted_;
  std::unique_ptr<EnergyAccount<T>> energy_;  // null unless the plan keeps the account
  std::unique_ptr<MediaStage<T>> media_;      // null unless Plan::media
  Array<T> time_;                             // times of the camera rays; filled only if Plan::shutter > 0
  const Draws* draws_ = nullptr;
  TraceResult<T>* out_ = nullptr;
  TraceCounts* counts_ = nullptr;
};

extern template class Wavefront<float>;
extern template class Wavefront<double>;

}  // namespace orrery
