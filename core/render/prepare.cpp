#include "core/render/prepare.h"

#include <chrono>

#include "core/accelerators/reordered.h"

namespace orrery {
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& type, double& build_ms) {
  const std::lock_guard lock(parts.mutex);
  auto& made = made_of<T>(parts);
  auto& accelerator = made.accelerators[&type];
  if (!accelerator) {
    const auto start = std::chrono::steady_clock::now();
    if (!made.geometry) made.geometry = make_geometry<T>(parts.scene);
    accelerator = build(type, made.geometry->primitives);
    build_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return {made.geometry, accelerator};
}

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const Plan& plan, double& build_ms) {
  World<T> world = world_for<T>(parts, *plan.accelerator, build_ms);
  if (plan.reorder) world.accelerator = reordered(std::move(world.accelerator));
  return world;
}

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template World<float> world_for(PreparedScene::Parts&, const Plan&, double&);
template World<double> world_for(PreparedScene::Parts&, const Plan&, double&);

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
}
PreparedScene::~PreparedScene() = default;
const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
