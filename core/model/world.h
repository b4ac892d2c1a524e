#pragma once

#include <memory>
#include <vector>

#include "core/model/accelerator.h"
#include "core/model/scene.h"

namespace orrery {

// A scene made ready for rays in one number type. Immutable once built.
template <class T>
struct World {
  struct Materials {
    MaterialKernelPtr<T> kernel;
    int first, last;  // material numbers first..last-1
    MaterialTraits traits;
  };

  std::shared_ptr<const Scene> scene;
  std::vector<ShapeKernelPtr<T>> shapes;
  std::vector<Materials> materials;
  std::vector<IndexOf<T>> material_of;
  PrimitiveList<T> primitives;
  AcceleratorPtr<T> accelerator;
  Vec3<T> ambient, background;
};

}  // namespace orrery
