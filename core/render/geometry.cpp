#include "core/render/geometry.h"

#include "core/shapes/instances.h"

namespace orrery {
namespace {

// Kernels of the sets, and their primitives, which are numbered on from `number`.
template <class T>
void add_shapes(const std::vector<std::unique_ptr<ShapeSet>>& sets, std::vector<ShapeKernelPtr<T>>& kernels,
                PrimitiveList<T>& primitives, int& number) {
  for (const auto& shapes : sets) {
    if (shapes->size() == 0) continue;
    kernels.push_back(shapes->kernel(T(), number));
    for (int i = 0; i < shapes->size(); ++i)
      primitives.push_back({kernels.back().get(), i, shapes->bounds(i)});
    number += shapes->size();
  }
}

template <class T>
std::shared_ptr<const ModelGeometry<T>> make_model(const Model& model, const AcceleratorType& inner) {
  auto geometry = std::make_shared<ModelGeometry<T>>();
  int number = 0;
  add_shapes(model.shapes, geometry->shapes, geometry->primitives, number);
  geometry->accelerator = build(inner, geometry->primitives);
  return geometry;
}

template <class T>
Placed<T> place(const Scene& scene, const Instance& instance,
                const std::shared_ptr<const ModelGeometry<T>>& model, int& number) {
  const Affined& world_from_model = instance.world_from_model;
  const Affined model_from_world = inverse(world_from_model);
  // Rows of the inverse stand at right angles, because instances are scaled before they are turned: so what
  // rounding moves a point across its surface grows with its coordinates alone, not with how uneven the scale
  // is. 2 > sqrt(3), the most by which a sum of three rows' errors exceeds their length.
  const double base =
      2 * 8 * double{std::numeric_limits<T>::epsilon()} * max_component(abs(world_from_model.origin));
  const int first = number;
  number += static_cast<int>(scene.models[instance.model].material_of.size());
  return {model,
          first,
          number,
          world_from_model.as<T>(),
          model_from_world.as<T>(),
          static_cast<T>(2 * stretch(world_from_model)),
          static_cast<T>(base)};
}

template <class T>
void add_instances(const Scene& scene, const AcceleratorType& inner, Geometry<T>& geometry, int& number) {
  if (scene.instances.empty()) return;
  std::vector<std::shared_ptr<const ModelGeometry<T>>> models;
  for (const Model& model : scene.models) models.push_back(make_model<T>(model, inner));
  PlacedList<T> placed;
  for (const Instance& instance : scene.instances)
    placed.push_back(place<T>(scene, instance, models[instance.model], number));
  geometry.shapes.push_back(std::make_unique<InstanceKernel<T>>(std::move(placed)));
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    geometry.primitives.push_back(
        {geometry.shapes.back().get(), static_cast<int>(i),
         bounds_of(scene.models[instance.model].bounds, instance.world_from_model)});
  }
}

}  // namespace

template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene,
                                                 const AcceleratorType& inner) {
  auto geometry = std::make_shared<Geometry<T>>();
  geometry->ambient = Vec3<T>(scene->ambient);
  geometry->background = Vec3<T>(scene->background);
  geometry->material_of.assign(scene->material_of.begin(), scene->material_of.end());
  geometry->primitives.reserve(scene->material_of.size());
  int number = 0;
  add_shapes(scene->shapes, geometry->shapes, geometry->primitives, number);
  add_instances(*scene, inner, *geometry, number);
  int first = 0;
  for (const auto& materials : scene->materials) {
    const int last = first + materials->size();
    if (last > first)
      geometry->materials.push_back({materials->kernel(T(), first), first, last, materials->traits()});
    first = last;
  }
  geometry->scene = std::move(scene);
  return geometry;
}

template std::shared_ptr<const Geometry<float>> make_geometry(std::shared_ptr<const Scene>,
                                                              const AcceleratorType&);
template std::shared_ptr<const Geometry<double>> make_geometry(std::shared_ptr<const Scene>,
                                                               const AcceleratorType&);

}  // namespace orrery
