#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/model/mesh_source.h"
#include "core/params/document.h"
#include "core/render/renderer.h"
#include "server/app/lru.h"

namespace orrery {

// Scenes by id, the hash of what they say, with what rendering has built for them. Some are kept on purpose;
// others were only rendered and are cached: these go first when room is needed, and never push out a kept
// one, so that who may render only cannot remove what others keep. Safe from any thread.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const PreparedScene>;

  explicit SceneStore(std::size_t most_bytes) : kept_(most_bytes), cached_(most_bytes) {}

  struct Kept {
    Prepared scene;
    bool known = false;  // it was kept before
  };
  // Keeps the scene that `document` says; loads it only if it is not here, also not as a cached one. Throws
  // what load_scene() does, and InputError if the scene alone is over the limit.
  Kept keep(const Document& document, const MeshSource& meshes);
  // The scene that `document` says, loaded only if it is not here, and then cached if there is room. Throws
  // what load_scene() does.
  Prepared get(const Document& document, const MeshSource& meshes);

  // Kept or cached. Throws NotFound.
  Prepared find(const std::string& id);
  void remove(const std::string& id);

  std::size_t bytes() const { return kept_.bytes() + cached_.bytes(); }
  // Since the start, of scenes asked for by what they say: found here, and loaded.
  std::uint64_t hits() const { return hits_; }
  std::uint64_t loads() const { return loads_; }

 private:
  Prepared find_known(const std::string& id);   // null: it is not here
  Prepared find_locked(const std::string& id);  // likewise, with mutex_ held
  Prepared find_or_load(const std::string& id, const Document& document, const MeshSource& meshes);

  std::mutex mutex_;  // held where both change together
  Lru<Prepared> kept_, cached_;
  std::atomic<std::uint64_t> hits_{0}, loads_{0};
};

}  // namespace orrery
