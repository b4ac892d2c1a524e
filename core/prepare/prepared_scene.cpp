#include "core/prepare/prepared_scene.h"

#include <algorithm>
#include <mutex>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/prepare/geometry.h"

namespace orrery {
namespace {

template <class T>
using Moments = std::list<PreparedScene::Parts::Moment<T>>;

// Moves the moment of `exposure` to the front. If the moment is missing, adds it, and evicts the last moment
// if there are then more than kMoments.
template <class T>
void move_to_front(Moments<T>& moments, const Exposure& exposure) {
  const auto known =
      std::find_if(moments.begin(), moments.end(), [&](const auto& m) { return m.exposure == exposure; });
  if (known != moments.end()) return moments.splice(moments.begin(), moments, known);
  moments.push_front({exposure, {}, {}});
  if (moments.size() > PreparedScene::kMoments) moments.pop_back();
}

// Returns the most recently used world with this accelerator type among all moments but the first. Returns an
// empty world if there is none.
template <class T>
World<T> world_before(const Moments<T>& moments, const AcceleratorType& type) {
  for (auto moment = std::next(moments.begin()); moment != moments.end(); ++moment)
    if (const auto made = moment->worlds.find(&type); made != moment->worlds.end()) return made->second;
  return {};
}

// Runs a build on behalf of the scene, and adds its time to `build_ms`.
void run_build(const PreparedScene::Parts& parts, double& build_ms, const std::stop_token& stop,
               const std::function<void()>& make) {
  const auto start = Clock::now();
  // No time slice, because the owner of the mutex must not yield.
  const TaskScope scope({TaskScope::current().memory, &stop});
  if (parts.run_build)
    parts.run_build(make);
  else
    make();
  build_ms += milliseconds_since(start);
}

}  // namespace

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& type, const Exposure& exposure,
                   double& build_ms, std::stop_token stop) {
  const auto lock = lock_unless(parts.mutex, stop);
  auto& moments = made_of<T>(parts).moments;
  move_to_front(moments, exposure);
  auto& moment = moments.front();
  World<T>& world = moment.worlds[&type];
  if (world.accelerator) return world;
  run_build(parts, build_ms, stop, [&] {
    const World<T> before = world_before(moments, type);
    auto& geometry = moment.geometries[parts.scene->models.empty() ? nullptr : &type];
    if (!geometry) geometry = make_geometry<T>(parts.scene, type, exposure, before.geometry.get());
    world = {geometry, build_or_refit(type, geometry->primitives, before.accelerator.get())};
  });
  return world;
}

template <class T>
World<T> lighting_for(PreparedScene::Parts& parts, const AcceleratorType& type, double& build_ms,
                      std::stop_token stop) {
  const auto lock = lock_unless(parts.mutex, stop);
  auto& lighting = made_of<T>(parts).lighting;
  if (!lighting) run_build(parts, build_ms, stop, [&] { lighting = make_lighting<T>(parts.scene); });
  return {lighting, build(type, lighting->primitives)};
}

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, const Exposure&, double&,
                                std::stop_token);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, const Exposure&, double&,
                                 std::stop_token);

template World<float> lighting_for(PreparedScene::Parts&, const AcceleratorType&, double&, std::stop_token);
template World<double> lighting_for(PreparedScene::Parts&, const AcceleratorType&, double&, std::stop_token);

std::unique_lock<StoppableMutex> lock_unless(StoppableMutex& mutex, const std::stop_token& stop) {
  if (!mutex.lock_unless(stop)) throw Cancelled();
  return {mutex, std::adopt_lock};
}

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene, RunBuild run_build)
    : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
  parts_->run_build = std::move(run_build);
}
PreparedScene::~PreparedScene() = default;

const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
