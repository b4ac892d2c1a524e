#include "server/cache/stored_scene.h"

namespace orrery {

StoredScene::StoredScene(std::shared_ptr<const Scene> scene)
    : PreparedScene(std::move(scene), [this](const std::function<void()>& make) { run_build(make); }) {
  if (WorkAccount* const memory = WorkAccount::current()) {
    loaded_ = memory->shared_from_this();
    loaded_bytes_ = memory->bytes();
  }
}

std::shared_ptr<const StoredScene> StoredScene::without_built() const {
  const auto fresh = std::make_shared<StoredScene>(shared_scene());
  fresh->loaded_ = loaded_;
  fresh->loaded_bytes_ = loaded_bytes_;
  return fresh;
}

std::size_t StoredScene::bytes() const {
  std::size_t bytes = loaded_bytes_;
  const std::lock_guard lock(mutex_);
  for (const auto& account : built_) bytes += account->bytes();
  return bytes;
}

void StoredScene::settle(bool loaded, bool built) const {
  if (loaded_) loaded_->settle(loaded ? loaded_->bytes() : 0);
  const std::lock_guard lock(mutex_);
  for (const auto& account : built_) account->settle(built ? account->bytes() : 0);
}

// Charges the build to a new account, and drops the accounts of evicted data.
void StoredScene::run_build(const std::function<void()>& make) {
  const WorkAccount* const client = WorkAccount::current();
  if (!client) return make();
  const auto account = client->open_another();
  {
    const TaskScope nobody({});
    const std::lock_guard lock(mutex_);
    std::erase_if(built_, [](const auto& some) { return some->bytes() == 0; });
    built_.push_back(account);
  }
  account->run(*TaskScope::current().stop, make);
}

}  // namespace orrery
