#include "core/render/prepare.h"

#include <chrono>

namespace orrery {
namespace {

template <class T>
std::unique_ptr<World<T>> build_world(const std::shared_ptr<const Scene>& scene,
                                      const AcceleratorType& accelerator) {
  auto world = std::make_unique<World<T>>();
  world->scene = scene;
  world->ambient = Vec3<T>(scene->ambient);
  world->background = Vec3<T>(scene->background);
  world->material_of.assign(scene->material_of.begin(), scene->material_of.end());
  world->primitives.reserve(scene->material_of.size());
  for (const auto& shapes : scene->shapes) {
    if (shapes->size() == 0) continue;
    world->shapes.push_back(shapes->kernel(T(), static_cast<int>(world->primitives.size())));
    for (int i = 0; i < shapes->size(); ++i)
      world->primitives.push_back({world->shapes.back().get(), i, shapes->bounds(i)});
  }
  int first = 0;
  for (const auto& materials : scene->materials) {
    const int last = first + materials->size();
    if (last > first)
      world->materials.push_back({materials->kernel(T(), first), first, last, materials->traits()});
    first = last;
  }
  world->accelerator = build(accelerator, world->primitives);
  return world;
}

}  // namespace

template <class T>
const World<T>& world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, double& build_ms) {
  const std::lock_guard lock(parts.mutex);
  auto& worlds = [&parts]() -> auto& {
    if constexpr (std::is_same_v<T, float>)
      return parts.float_worlds;
    else
      return parts.double_worlds;
  }
  ();
  auto& world = worlds[&accelerator];
  if (!world) {
    const auto start = std::chrono::steady_clock::now();
    world = build_world<T>(parts.scene, accelerator);
    build_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return *world;
}

template const World<float>& world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template const World<double>& world_for(PreparedScene::Parts&, const AcceleratorType&, double&);

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
}
PreparedScene::~PreparedScene() = default;
const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
