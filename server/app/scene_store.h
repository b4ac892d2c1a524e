#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/render/renderer.h"

namespace orrery {

// Scenes by id, with what rendering has built for them. Once they take more than the limit, those not used
// for longest are forgotten; who still renders one keeps it alive. Safe from any thread.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const PreparedScene>;

  explicit SceneStore(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  struct Added {
    Prepared scene;
    bool known;  // it was there before
  };
  // Throws InputError if the scene alone is over the limit.
  Added add(std::shared_ptr<const Scene> scene);
  // Throws NotFound.
  Prepared find(const std::string& id);
  void remove(const std::string& id);

  std::size_t bytes() const;

 private:
  struct Entry {
    Prepared scene;
    std::size_t bytes;
    std::list<std::string>::iterator use;
  };
  void touch(Entry& entry);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  std::list<std::string> uses_;  // ids, the latest use first
  std::size_t bytes_ = 0;
};

}  // namespace orrery
