#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/prepare/prepared_scene.h"
#include "server/scheduler/work_account.h"

namespace orrery {

// Prepared scene whose memory is counted. The loaded scene is charged to the memory account that is current
// in the constructor. Built data are charged to further accounts, opened from the source of the account that
// is current during the build. Without an account, memory is not counted. Thread-safe.
class StoredScene : public PreparedScene {
 public:
  explicit StoredScene(std::shared_ptr<const Scene> scene);
  // Returns the same scene, with the same account for the loaded scene, but without built data.
  std::shared_ptr<const StoredScene> without_built() const;

  // Return the bytes charged to the accounts. loaded_bytes() counts the loaded scene, bytes() the loaded
  // scene and built data.
  std::size_t loaded_bytes() const { return loaded_bytes_; }
  std::size_t bytes() const;
  // Excludes the current bytes of the loaded scene (if `loaded`) and of built data (if `built`) from the
  // limits of their accounts, because another owner is charged for these bytes.
  void settle(bool loaded, bool built) const;

 private:
  void run_build(const std::function<void()>& make);

  std::shared_ptr<WorkAccount> loaded_;  // null if memory is not counted
  std::size_t loaded_bytes_ = 0;         // bytes of the account `loaded_` at construction
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<WorkAccount>> built_;  // guarded by mutex_
};

}  // namespace orrery
