#include "core/render/prepare.h"

#include <algorithm>

#include "core/accelerators/reordered.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/render/geometry.h"
#include "core/render/occlusion_samples.h"

namespace orrery {
namespace {

template <class T>
using Moments = std::list<PreparedScene::Parts::Moment<T>>;

// Puts the moment of that time first.
template <class T>
void bring_forward(Moments<T>& moments, double time) {
  const auto known =
      std::find_if(moments.begin(), moments.end(), [&](const auto& m) { return m.time == time; });
  if (known != moments.end()) return moments.splice(moments.begin(), moments, known);
  moments.push_front({time, {}, {}});
  if (moments.size() > PreparedScene::kMoments) moments.pop_back();
}

// What was made with the accelerator for another moment than the first, the newest; an empty world if there
// is none.
template <class T>
World<T> world_before(const Moments<T>& moments, const AcceleratorType& type) {
  for (auto moment = std::next(moments.begin()); moment != moments.end(); ++moment)
    if (const auto made = moment->worlds.find(&type); made != moment->worlds.end()) return made->second;
  return {};
}

}  // namespace

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& type, double time, double& build_ms,
                   std::stop_token stop) {
  const auto lock = lock_unless(parts.mutex, stop);
  auto& moments = made_of<T>(parts).moments;
  bring_forward(moments, time);
  auto& moment = moments.front();
  World<T>& world = moment.worlds[&type];
  if (!world.accelerator) {
    const auto start = Clock::now();
    const World<T> before = world_before(moments, type);
    auto& geometry = moment.geometries[parts.scene->models.empty() ? nullptr : &type];
    if (!geometry) geometry = make_geometry<T>(parts.scene, type, time, before.geometry.get());
    world = {geometry, build_or_refit(type, geometry->primitives, before.accelerator.get())};
    build_ms += milliseconds_since(start);
  }
  return world;
}

namespace {

template <class T>
PredictorPtr<T> network_for(PreparedScene::Parts& parts, const World<T>& world, const Plan& plan,
                            double& build_ms, std::stop_token stop) {
  const auto lock = lock_unless(parts.trying, stop);
  PredictorPtr<T>& network = made_of<T>(parts).network;
  if (!network) {
    const auto start = Clock::now();
    network = network_predictor<T>(sample_occlusion(world, plan, stop));
    build_ms += milliseconds_since(start);
  }
  return network;
}

}  // namespace

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const Plan& plan, double& build_ms, std::stop_token stop) {
  const World<T> bare = world_for<T>(parts, *plan.accelerator, plan.time, build_ms, stop);
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

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, double, double&,
                                std::stop_token);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, double, double&,
                                 std::stop_token);
template World<float> world_for(PreparedScene::Parts&, const Plan&, double&, std::stop_token);
template World<double> world_for(PreparedScene::Parts&, const Plan&, double&, std::stop_token);

std::unique_lock<StoppableMutex> lock_unless(StoppableMutex& mutex, const std::stop_token& stop) {
  if (!mutex.lock_unless(stop)) throw Cancelled();
  return {mutex, std::adopt_lock};
}

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
}
PreparedScene::~PreparedScene() = default;
const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
