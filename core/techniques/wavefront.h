#pragma once

#include <vector>

#include "core/model/path.h"
#include "core/model/technique.h"

// The loop that all techniques share. A batch of rays passes whole through the stages
//   closest hit -> surface -> shading, which is the technique's -> deposit
// and the rays that shading sends out form the next batches. Nothing recurses: batches wait on a stack, at
// most two a depth, so memory is bounded whatever the scene. Which rays form a batch, and so the order in
// which a slot's light is summed, depends on the scene alone, not on lane width, slice or thread.
namespace orrery {

template <class T>
class Wavefront : public Tracer<T> {
 public:
  using N = Lanes<T>;

  Wavefront(const World<T>& world, const Plan& plan);
  bool trace(const RayBatch<T>& camera_rays, const Draws& draws, TraceResult<T>& out, TraceCounts& counts,
             const Checkpoint& checkpoint) final;

 protected:
  // What the current batch met.
  struct Vertices {
    PathBatch<T>* paths;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
    Vec3Array<T> radiance;  // toward each ray's origin, so far: background for rays that met nothing
  };

  // Adds the light that leaves surfaces toward the origins of the rays of `groups`, and sends on rays by
  // spawn(). `met`: the registers of them with a surface.
  virtual void shade(const Groups& groups, const Groups& met) = 0;

  // Before a batch of camera rays, and after all that followed from it; false once the work is to end.
  virtual void begin() {}
  virtual bool finish() { return true; }
  // Where the light of rays of this depth goes, by slot.
  virtual Vec3Array<T>& sums(int /*depth*/) { return out_->radiance; }

  enum class Kind { reflected, refracted };
  // A ray from the surface at register i along `direction` that carries `throughput` to its slot. Returns the
  // bits of the mask.
  unsigned spawn(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction,
                 const Vec3<N>& throughput);
  // The only one from there, and the density with which it was drawn.
  void spawn(int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& throughput, const N& pdf);
  // Enters rays that are not traced into the ledger, by their weights.
  void note_cut(int i, const MaskOf<N>& mask, const Vec3<N>& weight);

  // Light that is taken away, by slot.
  Vec3Array<T>& clamped() { return out_->clamped; }

  const Draws& batch_draws() const { return *draws_; }
  PathDraws<T> draws() const { return {*draws_, vertices_->paths->slot, vertices_->paths->depth}; }
  TraceCounts& counts() { return *counts_; }
  const Checkpoint& checkpoint() const { return *checkpoint_; }

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  std::unique_ptr<Vertices> vertices_;

 private:
  void start(const RayBatch<T>& camera_rays);
  void run(PathBatch<T>& paths);
  // Rays are of the time of their camera ray.
  void inherit_times(PathBatch<T>& paths) const;
  void run_slice(const Groups& groups);
  void record_channels(const Groups& groups, const Groups& met);
  std::unique_ptr<PathBatch<T>> take_batch(int depth);
  void push(std::unique_ptr<PathBatch<T>> batch);

  std::vector<std::unique_ptr<PathBatch<T>>> waiting_, spare_;
  std::unique_ptr<PathBatch<T>> reflected_, refracted_;
  Array<T> time_;  // of camera rays, by slot; filled only with Plan::shutter
  const Draws* draws_ = nullptr;
  TraceResult<T>* out_ = nullptr;
  TraceCounts* counts_ = nullptr;
  const Checkpoint* checkpoint_ = nullptr;
};

extern template class Wavefront<float>;
extern template class Wavefront<double>;

}  // namespace orrery
