#pragma once

#include <vector>

#include "core/lighting/texture_coordinates.h"
#include "core/math/exposure.h"
#include "core/model/path.h"
#include "core/model/record.h"
#include "core/model/scene.h"
#include "core/model/world.h"

namespace orrery {

// Evaluates the textures of a scene: sets SurfaceBatch::textured and `emitted`, and tilts shading normals by
// bump maps and normal maps. Immutable and thread-safe.
template <class T>
class TextureStage {
 public:
  // `exposure` determines the poses of moving instances. REQUIRES: the scene uses textures.
  TextureStage(const Scene& scene, const Exposure& exposure);

  // Evaluates the textures of every surface in `met`. REQUIRES: the fields texture_fields() are set. Changes
  // only `textured`, `emitted` and `normal` of `surface`.
  void apply(const Geometry<T>& geometry, const PathBatch<T>& paths, const LaneGroups& met,
             const HitBatch<T>& hits, SurfaceBatch<T>& surface) const;

 private:
  using N = Lanes<T>;
  struct Scratch;
  struct Batch;
  // TextureUse in lanes, by material. `used` is 0 for materials that do not use the texture in this slot.
  template <class M>
  struct Binding {
    M used;
    Vec3<M> scale, offset;
    Vec3<M> weights;  // weights of the channels, if the value is grey
    M rgb;            // 1: the value is the colour
    Vec3<M> least, most;
  };
  // Uses of one texture in one slot.
  struct Pass {
    int slot;
    std::vector<Binding<T>> by_material;
  };
  struct Entry {
    TextureKernelPtr<T> kernel;
    TextureMapping mapping;
    bool filtered, colored;
    bool binds = false, turns = false, tilts = false;  // sets values; has a normal map; has one or a bump map
    T detail;
    std::vector<Pass> passes;
    std::vector<char> used_by;  // by material
  };
  // Pose of an instance. The map is for the opening of the shutter.
  struct Pose {
    Affine<T> model_from_world;
    const Instance* moving;  // null if the instance does not move during the exposure
  };

  LaneGroups groups_of(const Entry& entry, const SurfaceBatch<T>& surface, const LaneGroups& met) const;
  void find_coordinates(const Entry& entry, const Batch& batch, Scratch& scratch) const;
  void find_uv(const Batch& batch, Scratch& scratch) const;
  Affine<N> model_from_world(const Batch& batch, int i) const;
  void bind(const Pass& pass, const Batch& batch, const Vec3Array<T>& values) const;
  void multiply_colors(const Batch& batch, Vec3Array<T>& values) const;
  void bump(const Entry& entry, const Pass& pass, const Batch& batch, Scratch& scratch) const;
  void turn_normals(const Pass& pass, const Batch& batch, const Scratch& scratch) const;
  Vec3<N> bound_value(const Pass& pass, const SurfaceBatch<T>& surface, int i, const Vec3<N>& value,
                      MaskOf<N>& mine) const;

  std::vector<Entry> entries_;
  std::size_t slots_ = 0;
  std::vector<Pose> poses_;  // by instance; empty if no texture follows instances
  Exposure exposure_;
};

extern template class TextureStage<float>;
extern template class TextureStage<double>;

}  // namespace orrery
