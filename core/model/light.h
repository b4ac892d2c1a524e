#pragma once

#include <memory>

#include "core/model/batch.h"

namespace orrery {

class Params;

// One light source as seen from every surface point of a batch.
template <class T>
struct LightBatch {
  // Rays that ask whether the light is seen. The light fills the unit direction toward it and t_max (metres
  // to it, infinite if it is directional, -1 if it sends nothing here); the origins are there before.
  RayBatch<T> shadow;
  Vec3Array<T> incident;       // intensity that arrives, after attenuation and cone
  Vec3Array<T> radiance;       // filled by the material: what leaves toward the viewer
  bool constant_half = false;  // one direction to the light and one to the viewer for the whole batch
};

// Convention: a white Lambert surface that faces a light of intensity 1 reads 1.
class Light {
 public:
  virtual ~Light() = default;
  // Fills direction, t_max and incident for `groups`. Const and free of state.
  virtual void illuminate(const SurfaceBatch<float>& surface, const Groups& groups,
                          LightBatch<float>& out) const = 0;
  virtual void illuminate(const SurfaceBatch<double>& surface, const Groups& groups,
                          LightBatch<double>& out) const = 0;
  virtual Vec3d intensity() const = 0;                // at the source
  virtual bool directional() const { return false; }  // the same direction everywhere
};

struct LightType {
  const char* name;
  const char* summary;
  std::unique_ptr<Light> (*make)(Params& params);
};

}  // namespace orrery
