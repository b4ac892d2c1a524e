#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/base/stoppable_mutex.h"
#include "core/base/work_scope.h"
#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/stages/prediction.h"

namespace orrery {

// A scene with what rendering it has built so far (its shapes in the render's precision, its accelerators),
// kept for the next frame. Safe to use from any number of threads; each part is built once. The memory of
// what was loaded is in the account of the scope that it was made in, if there was one; that of what is
// built, in another account of who has it built.
class PreparedScene {
 public:
  explicit PreparedScene(std::shared_ptr<const Scene> scene);
  ~PreparedScene();
  // The same scene and account, with nothing built yet.
  std::shared_ptr<const PreparedScene> without_built() const;

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // Bytes in these accounts: of the scene as it was loaded, and with what was built.
  std::size_t loaded_bytes() const;
  std::size_t bytes() const;
  // Whether others answer for them from now on, as many as there are now: for what was loaded, if `loaded`,
  // and for what was built, if `built`.
  void settle(bool loaded, bool built) const;

  // Of a scene that moves: for so many exposures, those asked for last, what was built is kept.
  static constexpr std::size_t kMoments = 2;

  struct Parts;
  Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// What was built for one scene so far.
struct PreparedScene::Parts {
  // The scene as it stands during one exposure.
  template <class T>
  struct Moment {
    Exposure exposure;
    // By the type of the models' structures; null if there are no models.
    std::map<const AcceleratorType*, std::shared_ptr<const Geometry<T>>> geometries;
    std::map<const AcceleratorType*, World<T>> worlds;
  };
  template <class T>
  struct Made {
    std::list<Moment<T>> moments;    // at most kMoments, the one asked for last first
    std::optional<Decision> chosen;  // by trial
    PredictorPtr<T> network;         // trained on the first plan that wanted one
  };
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<MemoryAccount> loaded;  // null: none
  std::size_t loaded_bytes = 0;           // of it, when the scene was made
  mutable std::mutex accounts_mutex;
  std::vector<std::shared_ptr<MemoryAccount>> built;  // guarded by accounts_mutex
  StoppableMutex trying;  // held while structures are tried or a network trained, so that it is done once
  StoppableMutex mutex;   // guards the rest; all is built under it, so that it is built once
  Made<float> made_float;
  Made<double> made_double;
};

// The scene in number type T with an accelerator, as it stands during an exposure; adds the milliseconds
// spent building, if any. Throws Cancelled if `stop` is requested while another built.
template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, const Exposure& exposure,
                   double& build_ms, std::stop_token stop = {});

// Waits for the mutex. Throws Cancelled once `stop` is requested.
std::unique_lock<StoppableMutex> lock_unless(StoppableMutex& mutex, const std::stop_token& stop);

// What was built in number type T.
template <class T>
PreparedScene::Parts::Made<T>& made_of(PreparedScene::Parts& parts) {
  if constexpr (std::is_same_v<T, float>)
    return parts.made_float;
  else
    return parts.made_double;
}

}  // namespace orrery
