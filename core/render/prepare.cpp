#include "core/render/prepare.h"

#include <chrono>

#include "core/accelerators/reordered.h"
#include "core/base/error.h"
#include "core/render/geometry.h"
#include "core/render/occlusion_samples.h"

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

namespace {

template <class T>
PredictorPtr<T> network_for(PreparedScene::Parts& parts, const World<T>& world, const Plan& plan,
                            double& build_ms, const std::function<bool()>& stop) {
  const auto lock = lock_unless(parts.trying, stop);
  PredictorPtr<T>& network = made_of<T>(parts).network;
  if (!network) {
    const auto start = std::chrono::steady_clock::now();
    network = network_predictor<T>(sample_occlusion(world, plan, stop));
    build_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return network;
}

}  // namespace

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const Plan& plan, double& build_ms,
                   const std::function<bool()>& stop) {
  const World<T> bare = world_for<T>(parts, *plan.accelerator, build_ms);
  const PrimitiveList<T>& primitives = bare.geometry->primitives;
  auto asked = plan.reorder ? reordered(bare.accelerator) : bare.accelerator;
  if (plan.prediction == Prediction::last)
    asked = predicted_by_last(primitives, std::move(asked));
  else if (plan.prediction == Prediction::random)
    asked = predicted(primitives, std::move(asked), random_predictor<T>(static_cast<int>(primitives.size())));
  else if (plan.prediction == Prediction::network)
    asked = predicted(primitives, std::move(asked), network_for(parts, bare, plan, build_ms, stop));
  return {bare.geometry, asked};
}

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, double&);
template World<float> world_for(PreparedScene::Parts&, const Plan&, double&, const std::function<bool()>&);
template World<double> world_for(PreparedScene::Parts&, const Plan&, double&, const std::function<bool()>&);

std::unique_lock<std::timed_mutex> lock_unless(std::timed_mutex& mutex, const std::function<bool()>& stop) {
  std::unique_lock lock(mutex, std::defer_lock);
  while (!lock.try_lock_for(std::chrono::milliseconds(10)))
    if (stop && stop()) throw Cancelled();
  return lock;
}

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
}
PreparedScene::~PreparedScene() = default;
const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
