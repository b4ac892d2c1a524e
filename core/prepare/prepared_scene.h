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

// Scene with the data built for rendering it (kernels and acceleration structures), cached for the next
// frame. Thread-safe; each part is built once. Memory of the loaded scene is charged to the account of the
// TaskScope that constructs it, if any. Memory of built data is charged to another account of the client that
// builds it.
class PreparedScene {
 public:
  explicit PreparedScene(std::shared_ptr<const Scene> scene);
  ~PreparedScene();
  // Returns the same scene with the same account and no built data.
  std::shared_ptr<const PreparedScene> without_built() const;

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // Returns the bytes charged to these accounts: for the loaded scene, and including built data.
  std::size_t loaded_bytes() const;
  std::size_t bytes() const;
  // Excludes the current bytes from the limits of these accounts, because another owner is charged: the
  // loaded scene if `loaded`, built data if `built`.
  void settle(bool loaded, bool built) const;

  // Number of exposures of a moving scene whose built data is cached, the most recently used ones.
  static constexpr std::size_t kMoments = 2;

  struct Parts;
  Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// Data built for one scene so far.
struct PreparedScene::Parts {
  // Scene during one exposure.
  template <class T>
  struct Moment {
    Exposure exposure;
    // By type of the models' structures; null if there are no models.
    std::map<const AcceleratorType*, std::shared_ptr<const Geometry<T>>> geometries;
    std::map<const AcceleratorType*, World<T>> worlds;
  };
  template <class T>
  struct BuiltData {
    std::list<Moment<T>> moments;    // at most kMoments, most recently used first
    std::optional<Decision> chosen;  // by measuring
    PredictorPtr<T> network;         // trained on the first plan that needs it
  };
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<MemoryAccount> loaded;  // null if not counted
  std::size_t loaded_bytes = 0;           // bytes of `loaded` when the scene was made
  mutable std::mutex accounts_mutex;
  std::vector<std::shared_ptr<MemoryAccount>> built;  // guarded by accounts_mutex
  StoppableMutex trying;  // held while structures are measured or a network is trained, so only once
  StoppableMutex mutex;   // guards the rest; held during builds, so that each part is built once
  BuiltData<float> made_float;
  BuiltData<double> made_double;
};

// Returns the scene in number type T with an accelerator for an exposure. Adds the milliseconds spent
// building, if any, to `build_ms`. Throws Cancelled if `stop` is requested, and the errors of
// AcceleratorType. Thread-safe.
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, const Exposure& exposure,
                   double& build_ms, std::stop_token stop = {});

// Locks the mutex. Throws Cancelled if `stop` is requested first.
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
