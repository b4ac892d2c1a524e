#pragma once

#include <vector>

#include "core/techniques/paths.h"

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
  bool trace(const RayBatch<T>& camera_rays, TraceResult<T>& out, TraceCounts& counts,
             std::stop_token stop) final;

 protected:
  // What the current batch met, for scatter(). Groups name the registers with a specular surface.
  struct Stage {
    PathBatch<T>* paths;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
    SpecularBatch<T> specular;
    LightBatch<T> light;
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
  MaskOf<N> specular_lanes(int i) const { return lanes_of(i, &MaterialTraits::mirrors); }

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  std::unique_ptr<Stage> stage_;

 private:
  void run(PathBatch<T>& paths);
  void run_slice(const Groups& groups);
  Groups find_surfaces(const Groups& groups);
  void find_materials(int i, const IndexLanes<T>& primitive);
  void light_surfaces(const Groups& groups);
  void light_from(const Light& light, const Groups& groups);
  void follow_specular(const Groups& groups);
  void bring_home(const Groups& groups);
  MaskOf<N> lanes_of(int i, bool MaterialTraits::*trait) const;
  Groups groups_of(const Groups& groups, bool MaterialTraits::*trait) const;
  std::unique_ptr<PathBatch<T>> take_batch(int depth);
  void push(std::unique_ptr<PathBatch<T>> batch);

  std::vector<std::unique_ptr<PathBatch<T>>> waiting_, spare_;
  std::unique_ptr<PathBatch<T>> reflected_, refracted_;
  TraceResult<T>* out_ = nullptr;
  TraceCounts* counts_ = nullptr;
};

extern template class Wavefront<float>;
extern template class Wavefront<double>;

}  // namespace orrery
