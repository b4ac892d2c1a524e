#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>

#include "core/base/stoppable_mutex.h"
#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/occlusion/prediction.h"

namespace orrery {

// Scene with cached data for rendering: kernels and acceleration structures. Thread-safe. One thread builds
// each part while other threads that need it wait: see world_for(). Worlds that world_for() has returned stay
// valid after eviction.
class PreparedScene {
 public:
  // Calls make(), which allocates built data and calls checkpoint(). A program that counts memory may call
  // make() in another TaskScope, without a time slice and with the same stop token.
  using RunBuild = std::function<void(const std::function<void()>& make)>;
  // Calls `run_build` for each build, if it is not null. It must be thread-safe.
  explicit PreparedScene(std::shared_ptr<const Scene> scene, RunBuild run_build = nullptr);
  ~PreparedScene();

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // Maximum number of exposures whose built data are cached. The least recently used exposure is evicted.
  static constexpr std::size_t kMoments = 2;

  struct Parts;
  Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// Data built for one scene.
struct PreparedScene::Parts {
  // Scene during one exposure.
  template <class T>
  struct Moment {
    Exposure exposure;
    // By the structure type of the models. The key is null if there are no models.
    std::map<const AcceleratorType*, std::shared_ptr<const Geometry<T>>> geometries;
    std::map<const AcceleratorType*, World<T>> worlds;
  };
  template <class T>
  struct BuiltData {
    std::list<Moment<T>> moments;                 // at most kMoments, most recently used first
    std::shared_ptr<const Geometry<T>> lighting;  // see make_lighting()
    std::optional<Decision> chosen;               // accelerator chosen by measurement
    PredictorPtr<T> network;                      // trained for the first plan that needs it
  };
  std::shared_ptr<const Scene> scene;
  RunBuild run_build;
  StoppableMutex trying;  // guards `chosen` and `network`; held while either is computed
  StoppableMutex
      mutex;  // guards `moments` and `lighting`; held during builds, so that each part is built once
  BuiltData<float> made_float;
  BuiltData<double> made_double;
};

// Returns the scene in number type T with an accelerator for an exposure. Builds both if they are not cached.
// Adds the build time in milliseconds to `build_ms`. Throws Cancelled if `stop` is requested, std::bad_alloc,
// and the errors of RunBuild and AcceleratorType. Thread-safe.
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, const Exposure& exposure,
                   double& build_ms, std::stop_token stop = {});

// Returns make_lighting() of the scene, with an accelerator without primitives. Otherwise as world_for().
template <class T>
World<T> lighting_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, double& build_ms,
                      std::stop_token stop = {});

// Locks the mutex. Throws Cancelled if `stop` is requested before the mutex is free.
std::unique_lock<StoppableMutex> lock_unless(StoppableMutex& mutex, const std::stop_token& stop);

// Returns the data built in number type T.
template <class T>
PreparedScene::Parts::BuiltData<T>& made_of(PreparedScene::Parts& parts) {
  if constexpr (std::is_same_v<T, float>)
    return parts.made_float;
  else
    return parts.made_double;
}

}  // namespace orrery
