#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/model/asset_source.h"
#include "core/params/document.h"
#include "core/prepare/prepared_scene.h"
#include "server/app/fair_shares.h"
#include "server/app/work_memory.h"

namespace orrery {

// Scenes by id, the hash of the document, with the structures built for rendering. Some scenes are kept on
// request; others were only rendered and are cached. Both are held by the clients that posted them.
// FairShares selects the client that gives up entries. It gives up cached scenes first, then the structures
// of kept scenes. Kept scenes are evicted only for other kept scenes, so a client that may only render cannot
// evict them. The store accounts for the memory of a stored scene. Before it is stored and after it is
// removed, its memory is charged to the client's work. Safe from any thread.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const PreparedScene>;

  SceneStore(std::size_t max_bytes, WorkMemory& work) : max_(max_bytes), work_(work) {}
  ~SceneStore();
  SceneStore(const SceneStore&) = delete;

  struct KeepResult {
    Prepared scene;
    bool known = false;  // it was already kept
  };
  // Keeps the scene of `document`. Loads it only if it is not stored, not even as a cached scene. Throws as
  // load_scene() and WorkMemory::open(), InputError if the scene alone exceeds the limit, and LimitExceeded
  // if other clients leave no room.
  KeepResult keep(const Document& document, const AssetSource& assets, const std::string& client);
  // Returns the scene of `document`. Loads it only if it is not stored, and then caches it if there is room.
  // Throws as load_scene() and WorkMemory::open().
  Prepared get(const Document& document, const AssetSource& assets, const std::string& client);

  // Returns a kept or cached scene. Throws NotFound.
  Prepared find(const std::string& id);
  // Releases the scene for the client, or with `of_all` for all clients. Removes it once no client holds it.
  // Throws NotFound, or HttpError 403 if only other clients hold it.
  void remove(const std::string& id, const std::string& client, bool of_all);

  // Scope in which structures may be built for the scene. Its end updates the size of the stored scene.
  class SizeGuard {
   public:
    SizeGuard(SceneStore& store, const PreparedScene& scene) : store_(store), scene_(scene) {}
    ~SizeGuard() { store_.measure(scene_); }
    SizeGuard(const SizeGuard&) = delete;

   private:
    SceneStore& store_;
    const PreparedScene& scene_;
  };

  std::size_t bytes() const;
  // Returns the number of scenes requested by document since the start: found in the store, and loaded.
  std::uint64_t hits() const { return hits_; }
  std::uint64_t loads() const { return loads_; }
  std::uint64_t evictions() const { return evictions_; }  // cached and kept scenes

 private:
  struct Entry {
    Prepared scene;
    std::size_t built = 0;  // bytes at the last measurement
  };

  Prepared find_or_load(const std::string& id, const Document& document, const AssetSource& assets,
                        const std::string& client);
  Prepared load(const Document& document, const AssetSource& assets, const std::string& client) const;
  void measure(const PreparedScene& scene);
  // REQUIRES for the functions below: mutex_ is held.
  Prepared find_locked(const std::string& id);  // counts as a use; null if not stored
  bool is_kept(const std::string& id) const;
  void hold(const std::string& id, const std::string& client, FairShares::Rank rank);
  bool add(const Prepared& scene, const std::string& client, FairShares::Rank rank);
  // Evicts entries as FairShares::make_room(). Returns false if the client would hold the most.
  bool make_room(const std::string& client, std::size_t bytes, FairShares::Ranks ranks);
  void weigh(const std::string& id);
  static void drop_built(Entry& entry);
  void erase(const std::string& id);

  const std::size_t max_;
  WorkMemory& work_;
  mutable std::mutex mutex_;  // guards all below
  std::map<std::string, Entry> scenes_;
  // Entries by id; the structures of a kept scene have an entry of their own.
  FairShares shares_{std::chrono::hours(1)};
  std::atomic<std::uint64_t> hits_{0}, loads_{0}, evictions_{0};
};

}  // namespace orrery
