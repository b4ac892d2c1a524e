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
template <class T>
class TextureStage;
struct Screen;

// Scene geometry in one number type, for one exposure. Immutable once built.
template <class T>
struct Geometry {
  struct Materials {
    MaterialKernelPtr<T> kernel;
    int first, last;  // materials `first` to `last` - 1
    MaterialTraits traits;
  };

  std::shared_ptr<const Scene> scene;
  std::vector<ShapeKernelPtr<T>> shapes;
  std::vector<std::shared_ptr<const ModelGeometry<T>>> models;
  std::vector<Materials> materials;
  // One per type, in the order of Scene::light_sets. Null for types without lights.
  std::vector<LightKernelPtr<T>> lights;
  std::shared_ptr<const TextureStage<T>> textures;  // null if no material uses a texture
  std::vector<Vec3<T>> emission;                    // by material: see Scene; empty if nothing emits
  // By material: SurfaceBatch::emitted replaces `emission`. Empty if no emission is textured.
  std::vector<char> has_textured_emission;
  // Kernel of the emitting primitives that can be sampled. Null if there are none.
  LightKernelPtr<T> emitters;
  std::vector<IndexOf<T>> emitter_of;  // by primitive: index in `emitters`, or -1
  // True if primitives outside `emitters` emit, or if an emitter is not sampled from some points that it
  // illuminates.
  bool emits_undrawn = false;
  // Contains the lights of the scene, then the emitters. Null if there are none.
  std::shared_ptr<const LightTree<T>> light_tree;
  AtmosphereKernelPtr<T> atmosphere;  // Scene::atmosphere; null if there is none
  LightKernelPtr<T> environment;      // its light 0 is Scene::environment; null if there is none
  std::vector<IndexOf<T>> material_of;
  PrimitiveList<T> primitives;
  Vec3<T> ambient, background;
};

// Scene geometry in one number type, and the structures that find visible surfaces. The geometry must outlive
// the accelerator.
template <class T>
struct World {
  std::shared_ptr<const Geometry<T>> geometry;
  std::shared_ptr<const Accelerator<T>> accelerator;
  // Triangles of the scene in the image of one plan. Null unless TechniqueType::rasterizes.
  std::shared_ptr<const Screen> screen = nullptr;
};

}  // namespace orrery
