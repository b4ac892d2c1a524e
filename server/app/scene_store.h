#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "core/model/asset_source.h"
#include "core/params/document.h"
#include "core/prepare/prepared_scene.h"
#include "server/app/work_memory.h"

namespace orrery {

// Scenes by id, the hash of what they say, with what rendering has built for them. Some are kept on purpose;
// others were only rendered and are cached. Where room is needed, those not used for longest go: first cached
// ones, then what was built for kept ones, and kept ones only for others that are kept, so that who may
// render only cannot remove what others keep. While a scene is here the store answers for its memory, before
// and after that the client's work. Safe from any thread.
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
  // what load_scene() does, InputError if the scene alone is over the limit, and as WorkMemory::open() says.
  Kept keep(const Document& document, const AssetSource& assets, const std::string& client);
  // The scene that `document` says, loaded only if it is not here, and then cached if there is room. Throws
  // likewise.
  Prepared get(const Document& document, const AssetSource& assets, const std::string& client);

  // Kept or cached. Throws NotFound.
  Prepared find(const std::string& id);
  // The client does not keep it any more: it goes unless others keep it, too, or with `of_all` in any case.
  // Throws NotFound if it is not here, HttpError 403 if others alone keep it.
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
    std::set<std::string> keepers;  // clients; none: it is only cached
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;

  Prepared find_or_load(const std::string& id, const Document& document, const AssetSource& assets,
                        const std::string& client);
  Prepared load(const Document& document, const AssetSource& assets, const std::string& client) const;
  void measure(const PreparedScene& scene);
  // Below: with mutex_ held.
  Entry* find_locked(const std::string& id);  // makes it the one used last; null: it is not here
  std::size_t kept_bytes() const;
  Prepared add(const Prepared& scene, const std::set<std::string>& keepers);
  void set_bytes(Entry& entry, std::size_t bytes);
  void erase(Entries::iterator entry);
  // Removes entries until all take at most so many bytes, or none is left that gives way.
  void drop_cached(std::size_t most_bytes);
  void drop_built(std::size_t most_bytes);
  void drop_kept(std::size_t most_bytes);

  const std::size_t most_;
  WorkMemory& work_;
  mutable std::mutex mutex_;  // guards all below
  Entries entries_;           // the latest use first
  std::map<std::string, Entries::iterator> by_id_;
  std::size_t bytes_ = 0;
  std::atomic<std::uint64_t> hits_{0}, loads_{0}, evictions_{0};
};

}  // namespace orrery
