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

// Scenes by id, the hash of what they say, with what rendering has built for them. Some are kept on purpose;
// others were only rendered and are cached. Both are held by the clients that posted them. Where room is
// needed, FairShares says which client gives up what: first its cached scenes, then what was built for its
// kept ones, and kept ones only for others that are kept, so that a client that may only render cannot remove
// what others keep. While a scene is here the store answers for its memory, before and after that the
// client's work. Safe from any thread.
class SceneStore {
 public:
  using Prepared = std::shared_ptr<const PreparedScene>;

  SceneStore(std::size_t most_bytes, WorkMemory& work) : most_(most_bytes), work_(work) {}
  ~SceneStore();
  SceneStore(const SceneStore&) = delete;

  struct Kept {
    Prepared scene;
    bool known = false;  // it was kept before
  };
  // Keeps the scene that `document` says; loads it only if it is not here, also not as a cached one. Throws
  // what load_scene() does, InputError if the scene alone is over the limit, OverLimit if others leave no
  // room for it, and as WorkMemory::open() says.
  Kept keep(const Document& document, const AssetSource& assets, const std::string& client);
  // The scene that `document` says, loaded only if it is not here, and then cached if there is room. Throws
  // likewise.
  Prepared get(const Document& document, const AssetSource& assets, const std::string& client);

  // Kept or cached. Throws NotFound.
  Prepared find(const std::string& id);
  // The client holds it no more: it goes unless others hold it, too, or with `of_all` in any case. Throws
  // NotFound if it is not here, HttpError 403 if others alone hold it.
  void remove(const std::string& id, const std::string& client, bool of_all);

  // Until its end something may be built for the scene, which is measured then.
  class Measured {
   public:
    Measured(SceneStore& store, const PreparedScene& scene) : store_(store), scene_(scene) {}
    ~Measured() { store_.measure(scene_); }
    Measured(const Measured&) = delete;

   private:
    SceneStore& store_;
    const PreparedScene& scene_;
  };

  std::size_t bytes() const;
  // Since the start, of scenes asked for by what they say: found here, and loaded.
  std::uint64_t hits() const { return hits_; }
  std::uint64_t loads() const { return loads_; }
  std::uint64_t evictions() const { return evictions_; }  // cached and kept

 private:
  struct Entry {
    Prepared scene;
    std::size_t built = 0;  // bytes, when they were last measured
  };

  Prepared find_or_load(const std::string& id, const Document& document, const AssetSource& assets,
                        const std::string& client);
  Prepared load(const Document& document, const AssetSource& assets, const std::string& client) const;
  void measure(const PreparedScene& scene);
  // Below: with mutex_ held.
  Prepared find_locked(const std::string& id);  // a use of it; null: it is not here
  bool is_kept(const std::string& id) const;
  void hold(const std::string& id, const std::string& client, FairShares::Rank rank);
  bool add(const Prepared& scene, const std::string& client, FairShares::Rank rank);
  // Has clients give up what FairShares says. False if the client would hold most.
  bool make_room(const std::string& client, std::size_t bytes, FairShares::Ranks ranks);
  void weigh(const std::string& id);
  static void drop_built(Entry& entry);
  void erase(const std::string& id);

  const std::size_t most_;
  WorkMemory& work_;
  mutable std::mutex mutex_;  // guards all below
  std::map<std::string, Entry> scenes_;
  // By id; what was built for a kept scene is an entry of its own.
  FairShares shares_{std::chrono::hours(1)};
  std::atomic<std::uint64_t> hits_{0}, loads_{0}, evictions_{0};
};

}  // namespace orrery
