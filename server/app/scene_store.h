#pragma once

#include <memory>
#include <string>

#include "core/render/renderer.h"
#include "server/app/lru.h"

namespace orrery {

// Scenes by id, with what rendering has built for them. Safe from any thread.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const PreparedScene>;

  explicit SceneStore(std::size_t most_bytes) : scenes_(most_bytes) {}

  struct Added {
    Prepared scene;
    bool known;  // it was there before
  };
  // Throws InputError if the scene alone is over the limit.
  Added add(std::shared_ptr<const Scene> scene);
  // Throws NotFound.
  Prepared find(const std::string& id);
  Prepared find_known(const std::string& id);  // null if it is not
  void remove(const std::string& id);

  std::size_t bytes() const { return scenes_.bytes(); }

 private:
  Lru<Prepared> scenes_;
};

}  // namespace orrery
