#pragma once

#include "core/model/light.h"

namespace orrery {

// A Light from a class with one template `fill<T>(surface, groups, out)`.
template <class Derived>
class LightOf : public Light {
 public:
  void illuminate(const SurfaceBatch<float>& surface, const Groups& groups,
                  LightBatch<float>& out) const override {
    static_cast<const Derived*>(this)->fill(surface, groups, out);
  }
  void illuminate(const SurfaceBatch<double>& surface, const Groups& groups,
                  LightBatch<double>& out) const override {
    static_cast<const Derived*>(this)->fill(surface, groups, out);
  }
};

template <class Derived>
std::unique_ptr<Light> make_light(Params& params) {
  return std::make_unique<Derived>(params);
}

}  // namespace orrery
