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

// Scene geometry in one number type at one moment. Immutable once made.
template <class T>
struct Geometry {
  struct Materials {
    MaterialKernelPtr<T> kernel;
    int first, last;  // materials first..last-1
    MaterialTraits traits;
  };

  std::shared_ptr<const Scene> scene;
  std::vector<ShapeKernelPtr<T>> shapes;
  std::vector<std::shared_ptr<const ModelGeometry<T>>> models;
  std::vector<Materials> materials;
  // By type, in the order of Scene::light_sets; null for types without lights.
  std::vector<LightKernelPtr<T>> lights;
  std::vector<Vec3<T>> emission;  // by material: see Scene; empty if nothing emits
  // Emitting primitives that light can be sampled from, in one kernel; null if there are none.
  LightKernelPtr<T> emitters;
  std::vector<IndexOf<T>> emitter_of;  // by primitive: its number in `emitters`, or -1
  // True if other primitives emit, or if some emitter is never sampled from points that can see it.
  bool emits_undrawn = false;
  // Lights of the scene, then the emitters; null if there are none.
  std::shared_ptr<const LightTree<T>> light_tree;
  LightKernelPtr<T> environment;  // its light 0; null if the background is constant
  std::vector<IndexOf<T>> material_of;
  PrimitiveList<T> primitives;
  Vec3<T> ambient, background;
};

// Scene geometry in one number type, and the acceleration structure over it. The geometry must outlive the
// accelerator.
template <class T>
struct World {
  std::shared_ptr<const Geometry<T>> geometry;
  std::shared_ptr<const Accelerator<T>> accelerator;
};

}  // namespace orrery
