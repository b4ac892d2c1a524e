#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/base/stoppable_mutex.h"
#include "core/base/task_scope.h"
#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/stages/prediction.h"

namespace orrery {

// Scene with cached data for rendering: kernels and acceleration structures. Thread-safe. One thread builds
// each part while other threads that need it wait: see world_for(). Worlds that world_for() has returned stay
// valid after eviction. The loaded scene is charged to the memory account that is current in the constructor.
// Built data are charged to further accounts, opened from the source of the account that is current during
// the build. Without an account, memory is not counted.
class PreparedScene {
 public:
  explicit PreparedScene(std::shared_ptr<const Scene> scene);
  ~PreparedScene();
  // Returns the same scene, with the same account for the loaded scene, but without built data.
  std::shared_ptr<const PreparedScene> without_built() const;

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // Return the bytes charged to the accounts. loaded_bytes() counts the loaded scene, bytes() the loaded
  // scene and built data.
  std::size_t loaded_bytes() const;
  std::size_t bytes() const;
  // Excludes the current bytes of the loaded scene (if `loaded`) and of built data (if `built`) from the
  // limits of their accounts, because another owner is charged for these bytes.
  void settle(bool loaded, bool built) const;

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
    std::list<Moment<T>> moments;    // at most kMoments, most recently used first
    std::optional<Decision> chosen;  // accelerator chosen by measurement
    PredictorPtr<T> network;         // trained for the first plan that needs it
  };
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<MemoryAccount> loaded;  // null if memory is not counted
  std::size_t loaded_bytes = 0;           // bytes of the account `loaded` at construction
  mutable std::mutex accounts_mutex;
  std::vector<std::shared_ptr<MemoryAccount>> built;  // guarded by accounts_mutex
  StoppableMutex trying;  // guards `chosen` and `network`; held while either is computed
  StoppableMutex mutex;   // guards `moments`; held during builds, so that each part is built once
  BuiltData<float> made_float;
  BuiltData<double> made_double;
};

// Returns the scene in number type T with an accelerator for an exposure. Builds both if they are not cached.
// Adds the build time in milliseconds to `build_ms`. Throws Cancelled if `stop` is requested, std::bad_alloc
// or the error of the memory account if memory is refused, and the errors of AcceleratorType. Thread-safe.
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, const Exposure& exposure,
                   double& build_ms, std::stop_token stop = {});

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
