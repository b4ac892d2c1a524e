#include "core/prepare/geometry.h"

#include <algorithm>

#include "core/accelerators/moving_instances.h"
#include "core/accelerators/static_and_moving_bvh.h"
#include "core/base/task_scope.h"
#include "core/lighting/light_tree.h"
#include "core/lighting/textures.h"
#include "core/prepare/emitting_surfaces.h"
#include "core/raster/screen.h"

namespace orrery {
namespace {

using ShapeSets = std::vector<std::unique_ptr<ShapeSet>>;

// Adds the kernels of the sets and their primitives, numbered from `number`. `before` is null or contains the
// kernels for another exposure. Kernels of static sets are reused. Shapes that move during the exposure get
// additional kernels in `moving`, which must fill surfaces after all other kernels.
template <class T>
void add_shapes(const ShapeSets& sets, const Exposure& exposure, const std::vector<ShapeKernelPtr<T>>* before,
                std::vector<ShapeKernelPtr<T>>& kernels, std::vector<ShapeKernelPtr<T>>& moving,
                PrimitiveList<T>& primitives, int& number) {
  for (const auto& shapes : sets) {
    if (shapes->size() == 0) continue;
    const auto posed = shapes->at(exposure.opens);
    const ShapeSet& now = posed ? *posed : *shapes;
    const bool known = before && !posed;
    kernels.push_back(known ? (*before)[kernels.size()] : now.kernel(T(), number));
    const auto moving_parts = exposure.instant() ? nullptr : shapes->during(exposure);
    if (moving_parts) moving.push_back(moving_parts->kernel(T(), number));
    for (int i = 0; i < now.size(); ++i) {
      checkpoint(static_cast<std::size_t>(i));
      if (moving_parts && shapes->moves(i))
        primitives.push_back({moving.back().get(), i, moving_parts->bounds(i)});
      else
        primitives.push_back({kernels.back().get(), i, now.bounds(i)});
    }
    number += now.size();
  }
}

bool rests(const ShapeSets& sets) {
  return std::all_of(sets.begin(), sets.end(),
                     [](const auto& shapes) { return shapes->key_times().empty(); });
}

template <class T>
std::shared_ptr<const ModelGeometry<T>> make_model(const Model& model, const AcceleratorType& inner,
                                                   const Exposure& exposure,
                                                   const std::shared_ptr<const ModelGeometry<T>>& before) {
  if (before && rests(model.shapes)) return before;
  auto geometry = std::make_shared<ModelGeometry<T>>();
  int number = 0;
  std::vector<ShapeKernelPtr<T>> moving;
  add_shapes(model.shapes, exposure, before ? &before->shapes : nullptr, geometry->shapes, moving,
             geometry->primitives, number);
  geometry->shapes.insert(geometry->shapes.end(), moving.begin(), moving.end());
  for (const auto& primitive : geometry->primitives) geometry->bounds.include(primitive.bounds);
  geometry->accelerator =
      build_or_refit(inner, geometry->primitives, before ? before->accelerator.get() : nullptr);
  return geometry;
}

template <class T>
PlacedInstance<T> place(const std::shared_ptr<const ModelGeometry<T>>& model, const Affined& world_from_model,
                        int first) {
  const Affined model_from_world = inverse(world_from_model);
  // Rows of the inverse are perpendicular, because instances are scaled before they are rotated. Rounding
  // therefore moves a point across its surface in proportion to its coordinates, even if the scale is not
  // uniform. The factor 2 exceeds sqrt(3), the largest ratio between the sum of the errors of three rows and
  // the length of the vector of these errors.
  const double base =
      2 * 8 * double{std::numeric_limits<T>::epsilon()} * max_component(abs(world_from_model.origin));
  return {model,
          first,
          first + static_cast<int>(model->primitives.size()),
          world_from_model.as<T>(),
          model_from_world.as<T>(),
          static_cast<T>(2 * stretch(world_from_model)),
          static_cast<T>(base)};
}

// Adds the instances. Instances that move during the exposure get a separate kernel in `moving`.
template <class T>
void add_instances(const Scene& scene, const AcceleratorType& inner, const Exposure& exposure,
                   const Geometry<T>* before, Geometry<T>& geometry, std::vector<ShapeKernelPtr<T>>& moving,
                   int& number) {
  if (scene.instances.empty()) return;
  for (std::size_t m = 0; m < scene.models.size(); ++m)
    geometry.models.push_back(
        make_model<T>(scene.models[m], inner, exposure, before ? before->models[m] : nullptr));
  PlacedList<T> resting;
  std::vector<MovingInstance<T>> moving_parts;
  struct Member {
    bool moves;
    Boundsd box;
  };
  std::vector<Member> members;
  for (const Instance& instance : scene.instances) {
    checkpoint();
    const auto& model = geometry.models[instance.model];
    const Affined world_from_model = instance.world_from_model(exposure.opens);
    const bool moves =
        !exposure.instant() && (instance.motion.times.size() > 1 || any_timed(model->primitives));
    if (moves)
      moving_parts.emplace_back(instance, model, number, exposure);
    else
      resting.push_back(place<T>(model, world_from_model, number));
    members.push_back({moves, moves ? bounds_during(model->bounds, instance, exposure)
                                    : bounds_of(model->bounds, world_from_model)});
    number += static_cast<int>(model->primitives.size());
  }
  if (!resting.empty()) geometry.shapes.push_back(std::make_shared<InstanceKernel<T>>(std::move(resting)));
  if (!moving_parts.empty())
    moving.push_back(std::make_shared<MovingInstanceKernel<T>>(std::move(moving_parts)));
  int resting_index = 0, moving_index = 0;
  for (const auto& [moves, box] : members) {
    const auto* kernel = (moves ? moving : geometry.shapes).back().get();
    geometry.primitives.push_back({kernel, moves ? moving_index++ : resting_index++, box});
  }
}

// Adds all members that do not refer to shapes.
template <class T>
void add_lighting(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry) {
  if (!scene.texture_uses.empty())
    geometry.textures = std::make_shared<const TextureStage<T>>(scene, exposure);
  geometry.ambient = Vec3<T>(scene.ambient);
  geometry.background = Vec3<T>(scene.background);
  geometry.material_of.assign(scene.material_of.begin(), scene.material_of.end());
  int first = 0;
  for (const auto& materials : scene.materials) {
    const int last = first + materials->size();
    if (last > first)
      geometry.materials.push_back({materials->kernel(T(), first), first, last, materials->traits()});
    first = last;
  }
  if (scene.facts.materials.emits)
    for (const Vec3d& emission : scene.emission) geometry.emission.push_back(Vec3<T>(emission));
  for (const TextureUse& use : scene.texture_uses) {
    if (use.slot != kEmissionSlot) continue;
    geometry.has_textured_emission.resize(scene.emission.size());
    geometry.has_textured_emission[static_cast<std::size_t>(use.material)] = true;
  }
  for (const auto& lights : scene.light_sets)
    geometry.lights.push_back(lights->size() > 0 ? lights->kernel(T()) : nullptr);
  if (scene.atmosphere) geometry.atmosphere = scene.atmosphere->kernel(T());
  if (scene.environment) geometry.environment = scene.environment->kernel(T());
}

template <class T>
void add_light_tree(const Scene& scene, const std::vector<LightBounds>& emitters, Geometry<T>& geometry) {
  std::vector<LightBounds> lights;
  for (const LightPlace& light : scene.lights)
    lights.push_back(scene.light_sets[light.set]->bounds(light.index));
  lights.insert(lights.end(), emitters.begin(), emitters.end());
  if (!lights.empty()) geometry.light_tree = std::make_shared<LightTree<T>>(lights);
}

}  // namespace

template <class T>
AcceleratorPtr<T> build_or_refit(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                 const Accelerator<T>* before) {
  if (any_timed(primitives)) return build_static_and_moving(type, primitives, before);
  AcceleratorPtr<T> accelerator = before ? before->refitted(primitives) : nullptr;
  return accelerator ? std::move(accelerator) : build(type, primitives);
}

template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner, const Exposure& exposure,
                                                 const Geometry<T>* before) {
  auto geometry = std::make_shared<Geometry<T>>();
  add_lighting(*scene, exposure, *geometry);
  geometry->primitives.reserve(scene->material_of.size());
  int number = 0;
  std::vector<ShapeKernelPtr<T>> moving;
  add_shapes(scene->shapes, exposure, before ? &before->shapes : nullptr, geometry->shapes, moving,
             geometry->primitives, number);
  add_instances(*scene, inner, exposure, before, *geometry, moving, number);
  geometry->shapes.insert(geometry->shapes.end(), moving.begin(), moving.end());
  add_light_tree(*scene, add_emitters(*scene, exposure, *geometry), *geometry);
  geometry->scene = std::move(scene);
  return geometry;
}

template <class T>
std::shared_ptr<const Geometry<T>> make_lighting(std::shared_ptr<const Scene> scene) {
  auto geometry = std::make_shared<Geometry<T>>();
  add_lighting(*scene, {}, *geometry);
  geometry->scene = std::move(scene);
  return geometry;
}

template <class T>
AcceleratorFacts facts_of(const World<T>& world) {
  if (world.screen) return {.bytes = world.screen->bytes(), .references = world.screen->surfaces.size()};
  AcceleratorFacts facts = world.accelerator->facts();
  int deepest = 0;
  for (const auto& model : world.geometry->models) {
    const AcceleratorFacts own = model->accelerator->facts();
    facts.bytes += own.bytes;
    facts.references += own.references;
    deepest = std::max(deepest, own.depth);
  }
  facts.depth += deepest;
  return facts;
}

template std::shared_ptr<const Geometry<float>> make_lighting(std::shared_ptr<const Scene>);
template std::shared_ptr<const Geometry<double>> make_lighting(std::shared_ptr<const Scene>);
template AcceleratorFacts facts_of(const World<float>&);
template AcceleratorFacts facts_of(const World<double>&);
template std::shared_ptr<const Geometry<float>> make_geometry(std::shared_ptr<const Scene>,
                                                              const AcceleratorType&, const Exposure&,
                                                              const Geometry<float>*);
template std::shared_ptr<const Geometry<double>> make_geometry(std::shared_ptr<const Scene>,
                                                               const AcceleratorType&, const Exposure&,
                                                               const Geometry<double>*);
template AcceleratorPtr<float> build_or_refit(const AcceleratorType&, const PrimitiveList<float>&,
                                              const Accelerator<float>*);
template AcceleratorPtr<double> build_or_refit(const AcceleratorType&, const PrimitiveList<double>&,
                                               const Accelerator<double>*);

}  // namespace orrery
