#include "core/model/world.h"

namespace orrery {

template <class T>
std::shared_ptr<const Geometry<T>> make_geometry(std::shared_ptr<const Scene> scene) {
  auto geometry = std::make_shared<Geometry<T>>();
  geometry->ambient = Vec3<T>(scene->ambient);
  geometry->background = Vec3<T>(scene->background);
  geometry->material_of.assign(scene->material_of.begin(), scene->material_of.end());
  geometry->primitives.reserve(scene->material_of.size());
  for (const auto& shapes : scene->shapes) {
    if (shapes->size() == 0) continue;
    geometry->shapes.push_back(shapes->kernel(T(), static_cast<int>(geometry->primitives.size())));
    for (int i = 0; i < shapes->size(); ++i)
      geometry->primitives.push_back({geometry->shapes.back().get(), i, shapes->bounds(i)});
  }
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

template std::shared_ptr<const Geometry<float>> make_geometry(std::shared_ptr<const Scene>);
template std::shared_ptr<const Geometry<double>> make_geometry(std::shared_ptr<const Scene>);

}  // namespace orrery
