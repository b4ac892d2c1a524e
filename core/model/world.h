#pragma once

#include <memory>
#include <vector>

#include "core/model/accelerator.h"
#include "core/model/scene.h"

namespace orrery {

template <class T>
struct ModelGeometry;
template <class T>
class LightTree;

// A scene in one number type, as it stands at one moment. Immutable once made.
template <class T>
struct Geometry {
  struct Materials {
    MaterialKernelPtr<T> kernel;
    int first, last;  // material numbers first..last-1
    MaterialTraits traits;
  };

  std::shared_ptr<const Scene> scene;
  std::vector<ShapeKernelPtr<T>> shapes;
  std::vector<std::shared_ptr<const ModelGeometry<T>>> models;
  std::vector<Materials> materials;
  std::vector<LightKernelPtr<T>>
      lights;                     // one a type, in the order of Scene::light_sets; null if it has none
  std::vector<Vec3<T>> emission;  // by material: see Scene; empty if nothing in the scene emits
  // Primitives that emit and that light can be drawn from, all in one kernel: null if there are none.
  LightKernelPtr<T> emitters;
  std::vector<IndexOf<T>> emitter_of;  // of each primitive: its number there, or -1
  // Whether other primitives emit, or there are points that see some of these from which none is drawn.
  bool emits_undrawn = false;
  // The lights of the scene, then the emitters: null if there are none.
  std::shared_ptr<const LightTree<T>> light_tree;
  LightKernelPtr<T> environment;  // its light 0; null: the background is the same everywhere
  std::vector<IndexOf<T>> material_of;
  PrimitiveList<T> primitives;
  Vec3<T> ambient, background;
};

// A scene made ready for rays: what there is, and the structure that finds what they meet. The geometry
// outlives the accelerator.
template <class T>
struct World {
  std::shared_ptr<const Geometry<T>> geometry;
  std::shared_ptr<const Accelerator<T>> accelerator;
};

}  // namespace orrery
