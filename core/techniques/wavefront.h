#pragma once

#include <vector>

#include "core/model/path.h"
#include "core/model/technique.h"
#include "core/stages/direct_light.h"
#include "core/stages/lane_masks.h"

// The loop that all techniques share. A batch of rays passes whole through the stages
//   closest hit -> surface -> ambient and direct light -> shadow rays -> scattering
// and the rays that scattering sends out form the next batches. Nothing recurses: batches wait on a stack, at
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
  // What the current batch met, for scatter(). Groups name the registers with a specular surface.
  struct Vertices {
    PathBatch<T>* paths;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
    SpecularBatch<T> specular;
    Vec3Array<T> radiance;  // toward each ray's origin, so far
  };

  // Sends on the light of specular surfaces: calls spawn() or cut() for the lanes of each group.
  virtual void scatter(const Groups& groups) = 0;

  enum class Kind { reflected, refracted };
  // A ray from the surface at register i along `direction` with `weight` (per channel) of what it will find.
  // If it would be too deep or too weak it is cut instead.
  void spawn(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& weight);
  // Stands in for rays that are not traced: ambient light, entered into the ledger.
  void cut(int i, const MaskOf<N>& mask, const Vec3<N>& weight);
  // Lanes of register i whose material is specular.
  MaskOf<N> specular_lanes(int i) const {
    return lanes_with(geometry_, vertices_->surface, i, &MaterialTraits::mirrors);
  }

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  std::unique_ptr<Vertices> vertices_;

 private:
  void start(const RayBatch<T>& camera_rays);
  void run(PathBatch<T>& paths);
  void run_slice(const Groups& groups);
  void record_channels(const Groups& groups, const Groups& met);
  std::unique_ptr<PathBatch<T>> take_batch(int depth);
  void push(std::unique_ptr<PathBatch<T>> batch);

  const std::unique_ptr<DirectLight<T>> direct_light_;
  std::vector<std::unique_ptr<PathBatch<T>>> waiting_, spare_;
  std::unique_ptr<PathBatch<T>> reflected_, refracted_;
  const Draws* draws_ = nullptr;
  TraceResult<T>* out_ = nullptr;
  TraceCounts* counts_ = nullptr;
  const Checkpoint* checkpoint_ = nullptr;
};

extern template class Wavefront<float>;
extern template class Wavefront<double>;

}  // namespace orrery
