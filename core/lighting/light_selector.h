#pragma once

#include "core/model/world.h"

namespace orrery {

// Selects the lights that illuminate a surface: all lights of the scene, in order, each with probability 1.
template <class T>
class LightSelector {
 public:
  explicit LightSelector(const Geometry<T>& geometry) : geometry_(geometry) {}

  // Calls visit(kernel, choice, traits) for each selected light.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const Scene& scene = *geometry_.scene;
    for (const LightPlace& light : scene.lights)
      visit(*geometry_.lights[light.set], LightChoice<T>{light.index, 1},
            scene.light_sets[light.set]->traits());
  }

 private:
  const Geometry<T>& geometry_;
};

}  // namespace orrery
