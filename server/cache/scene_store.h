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
#include "server/base/fair_shares.h"
#include "server/cache/stored_scene.h"
#include "server/scheduler/work_memory.h"

namespace orrery {

// Store of scenes with their acceleration structures, keyed by the hash of the document. A scene is kept if a
// client stored it, and cached if clients only rendered it. Each scene is held by the clients that posted it.
// FairShares selects the client that loses entries: first cached scenes, then the structures of kept scenes.
// A kept scene is evicted only for another kept scene, so that clients without the scope write cannot evict
// it. The memory of a stored scene is charged to the store. Before the scene is stored and after it is
// removed, its memory is charged to the work that uses it. Thread-safe.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const StoredScene>;

  SceneStore(std::size_t max_bytes, WorkMemory& work) : max_(max_bytes), work_(work) {}
  ~SceneStore();
  SceneStore(const SceneStore&) = delete;

  struct KeepResult {
    Prepared scene;
    bool known = false;  // it was already kept
  };
  // Keeps the scene of `document`. Loads it only if it is not stored, not even as a cached scene. Throws the
  // errors of load_scene() and WorkMemory::open(). Throws InputError if the scene alone exceeds the limit,
  // and LimitExceeded if scenes of other clients leave too few bytes.
  KeepResult keep(const Document& document, const AssetSource& assets, const std::string& client);
  // Returns the scene of `document`. Loads it only if it is not stored, and then caches it if it fits. Throws
  // the errors of load_scene() and WorkMemory::open().
  Prepared get(const Document& document, const AssetSource& assets, const std::string& client);

  // Returns a kept or cached scene. Throws NotFound if it is not stored.
  Prepared find(const std::string& id);
  // Releases the scene for the client, or with `of_all` for all clients. Removes it once no client holds it.
  // Throws NotFound, or Forbidden if only other clients hold it.
  void remove(const std::string& id, const std::string& client, bool of_all);

  // Scope in which acceleration structures of the scene may be built. Its end updates the size of the stored
  // scene.
  class SizeGuard {
   public:
    SizeGuard(SceneStore& store, const StoredScene& scene) : store_(store), scene_(scene) {}
    ~SizeGuard() { store_.measure(scene_); }
    SizeGuard(const SizeGuard&) = delete;

   private:
    SceneStore& store_;
    const StoredScene& scene_;
  };

  std::size_t bytes() const;
  // Return the number of scenes requested by document since the start: those found in the store, and those
  // loaded.
  std::uint64_t hits() const { return hits_; }
  std::uint64_t loads() const { return loads_; }
  std::uint64_t evictions() const { return evictions_; }  // cached and kept scenes

 private:
  struct Entry {
    Prepared scene;
    std::size_t built = 0;  // bytes of its structures when last measured
  };

  Prepared find_or_load(const std::string& id, const Document& document, const AssetSource& assets,
                        const std::string& client);
  Prepared load(const Document& document, const AssetSource& assets, const std::string& client) const;
  void measure(const StoredScene& scene);
  // REQUIRES for the functions below: mutex_ is held.
  Prepared find_locked(const std::string& id);  // counts as a use; null if not stored
  bool is_kept(const std::string& id) const;
  void hold(const std::string& id, const std::string& client, FairShares::Rank rank);
  bool add(const Prepared& scene, const std::string& client, FairShares::Rank rank);
  // Evicts entries. Returns false if FairShares::make_room() returns nullopt.
  bool make_room(const std::string& client, std::size_t bytes, FairShares::Ranks ranks);
  void weigh(const std::string& id);
  static void drop_built(Entry& entry);
  void erase(const std::string& id);

  const std::size_t max_;
  WorkMemory& work_;
  mutable std::mutex mutex_;  // guards the members below
  std::map<std::string, Entry> scenes_;
  // Entries by id. The structures of a kept scene have a separate entry with the id built_id().
  FairShares shares_{std::chrono::hours(1)};
  std::atomic<std::uint64_t> hits_{0}, loads_{0}, evictions_{0};
};

}  // namespace orrery
