#include "core/render/prepare.h"

#include <chrono>

#include "core/render/geometry.h"

namespace orrery {
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& type, double& build_ms) {
  const std::lock_guard lock(parts.mutex);
  auto& made = made_of<T>(parts);
  World<T>& world = made.worlds[&type];
  if (!world.accelerator) {
    const auto start = std::chrono::steady_clock::now();
    auto& geometry = made.geometries[parts.scene->models.empty() ? nullptr : &type];
    if (!geometry) geometry = make_geometry<T>(parts.scene, type);
    world = {geometry, build(type, geometry->primitives)};
    build_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return world;
}

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
}
PreparedScene::~PreparedScene() = default;
const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
