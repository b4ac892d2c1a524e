#include "server/cache/scene_store.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/load/load.h"
#include "server/base/errors.h"

namespace orrery {

namespace {

constexpr FairShares::Rank kCached = 0, kBuilt = 1, kKept = 2;

std::string built_id(const std::string& id) { return id + " built"; }

}  // namespace

SceneStore::~SceneStore() {
  for (const auto& [id, entry] : scenes_) entry.scene->settle(false, false);
}

SceneStore::KeepResult SceneStore::keep(const Document& document, const AssetSource& assets,
                                        const std::string& client) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, assets, client);
  if (scene->loaded_bytes() > max_)
    throw InputError("", "scene takes " + grouped(scene->loaded_bytes()) + " bytes of memory (limit " +
                             grouped(max_) + ", scene_cache_bytes)");
  const std::lock_guard lock(mutex_);
  if (Prepared known = find_locked(id)) {
    const bool was_kept = is_kept(id);
    hold(id, client, kKept);
    return {known, was_kept};
  }
  if (add(scene, client, kKept)) return {scene, false};
  constexpr double kRetry_s = 30;
  throw LimitExceeded("scenes of other clients leave no room for " + grouped(scene->loaded_bytes()) +
                          " more bytes (limit " + grouped(max_) + ", scene_cache_bytes)",
                      kRetry_s, "scene_cache_bytes");
}

SceneStore::Prepared SceneStore::get(const Document& document, const AssetSource& assets,
                                     const std::string& client) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, assets, client);
  const std::lock_guard lock(mutex_);
  if (Prepared known = find_locked(id)) {
    hold(id, client, kCached);
    return known;
  }
  if (scene->loaded_bytes() <= max_) add(scene, client, kCached);
  return scene;
}

SceneStore::Prepared SceneStore::find_or_load(const std::string& id, const Document& document,
                                              const AssetSource& assets, const std::string& client) {
  {
    const std::lock_guard lock(mutex_);
    if (Prepared known = find_locked(id)) {
      ++hits_;
      return known;
    }
  }
  const Prepared loaded = load(document, assets, client);
  ++loads_;
  return loaded;
}

SceneStore::Prepared SceneStore::load(const Document& document, const AssetSource& assets,
                                      const std::string& client) const {
  const std::stop_token* const stop = TaskScope::current().stop;
  return work_.open(client)->run(stop ? *stop : std::stop_token(), [&] {
    return std::make_shared<const StoredScene>(load_scene(document, assets));
  });
}

SceneStore::Prepared SceneStore::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (Prepared known = find_locked(id)) return known;
  throw NotFound("unknown scene " + id.substr(0, 64) + " (it may have been evicted; post it again)");
}

void SceneStore::remove(const std::string& id, const std::string& client, bool of_all) {
  const std::lock_guard lock(mutex_);
  if (scenes_.count(id) == 0) throw NotFound("unknown scene " + id.substr(0, 64));
  if (of_all) return erase(id);
  if (!shares_.holds(id, client))
    throw Forbidden("scene can be removed only by a client that posted it or with a token of scope admin");
  shares_.release(built_id(id), client);
  if (shares_.release(id, client)) return erase(id);
  weigh(id);
}

void SceneStore::measure(const StoredScene& scene) {
  const std::lock_guard lock(mutex_);
  const auto known = scenes_.find(scene.scene().id);
  const bool here = known != scenes_.end();
  if (!here || known->second.scene.get() != &scene) return scene.settle(here, false);
  known->second.built = scene.bytes() - scene.loaded_bytes();
  scene.settle(true, true);
  weigh(known->first);
  make_room("", 0, {.own = kKept, .others = kKept});
}

std::size_t SceneStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return shares_.weight();
}

SceneStore::Prepared SceneStore::find_locked(const std::string& id) {
  const auto known = scenes_.find(id);
  if (known == scenes_.end()) return nullptr;
  shares_.touch(id);
  shares_.touch(built_id(id));
  return known->second.scene;
}

bool SceneStore::is_kept(const std::string& id) const { return shares_.rank(id) == kKept; }

void SceneStore::hold(const std::string& id, const std::string& client, FairShares::Rank rank) {
  shares_.hold(id, client, std::max(rank, shares_.rank(id, client).value_or(kCached)));
  if (shares_.rank(built_id(id))) shares_.hold(built_id(id), client, kBuilt);
  weigh(id);
}

bool SceneStore::add(const Prepared& scene, const std::string& client, FairShares::Rank rank) {
  const FairShares::Rank below = rank == kKept ? FairShares::kRanks : kBuilt;
  if (!make_room(client, scene->loaded_bytes(), {.own = below, .others = below})) return false;
  scenes_.emplace(scene->scene().id, Entry{scene});
  scene->settle(true, false);
  hold(scene->scene().id, client, rank);
  return true;
}

bool SceneStore::make_room(const std::string& client, std::size_t bytes, FairShares::Ranks ranks) {
  const auto evicted = shares_.make_room(client, bytes, max_, ranks);
  if (!evicted) return false;
  for (const std::string& id : *evicted) {
    if (scenes_.count(id) > 0) {
      ++evictions_;
      erase(id);
    } else if (const auto built_for = scenes_.find(id.substr(0, id.rfind(built_id(""))));
               built_for != scenes_.end()) {
      drop_built(built_for->second);
    }
  }
  return true;
}

// Updates the weight of a scene in shares_. The weight of a cached scene includes its structures. The
// structures of a kept scene are a separate entry, so that they can be evicted alone.
void SceneStore::weigh(const std::string& id) {
  const Entry& entry = scenes_.at(id);
  const std::size_t loaded = entry.scene->loaded_bytes();
  const bool is_separate = is_kept(id) && entry.built > 0;
  shares_.set_weight(id, is_separate ? loaded : loaded + entry.built);
  if (!is_separate) return shares_.erase(built_id(id));
  if (!shares_.rank(built_id(id)))
    for (const std::string& client : shares_.holders(id)) shares_.hold(built_id(id), client, kBuilt);
  shares_.set_weight(built_id(id), entry.built);
}

void SceneStore::drop_built(Entry& entry) {
  entry.scene->settle(true, false);
  entry.scene = entry.scene->without_built();
  entry.built = 0;
}

void SceneStore::erase(const std::string& id) {
  const auto scene = scenes_.find(id);
  scene->second.scene->settle(false, false);
  shares_.erase(built_id(id));
  shares_.erase(id);
  scenes_.erase(scene);
}

}  // namespace orrery
