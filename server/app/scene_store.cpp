#include "server/app/scene_store.h"

#include <iterator>

#include "core/base/error.h"
#include "core/load/load.h"
#include "server/http/message.h"

namespace orrery {

SceneStore::~SceneStore() {
  while (!entries_.empty()) erase(entries_.begin());
}

SceneStore::Kept SceneStore::keep(const Document& document, const AssetSource& assets,
                                  const std::string& client) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, assets, client);
  if (scene->loaded_bytes() > most_)
    throw InputError("", "the scene takes " + std::to_string(scene->loaded_bytes()) +
                             " bytes of memory, at most " + std::to_string(most_) +
                             " are kept (store_bytes)");
  const std::lock_guard lock(mutex_);
  Entry* const known = find_locked(id);
  if (!known) return {add(scene, {client}), false};
  const bool was_kept = !known->keepers.empty();
  known->keepers.insert(client);
  return {known->scene, was_kept};
}

SceneStore::Prepared SceneStore::get(const Document& document, const AssetSource& assets,
                                     const std::string& client) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, assets, client);
  const std::lock_guard lock(mutex_);
  if (const Entry* const known = find_locked(id)) return known->scene;
  return scene->loaded_bytes() <= most_ - kept_bytes() ? add(scene, {}) : scene;
}

SceneStore::Prepared SceneStore::find_or_load(const std::string& id, const Document& document,
                                              const AssetSource& assets, const std::string& client) {
  {
    const std::lock_guard lock(mutex_);
    if (const Entry* const known = find_locked(id)) {
      ++hits_;
      return known->scene;
    }
  }
  const Prepared loaded = load(document, assets, client);
  ++loads_;
  return loaded;
}

SceneStore::Prepared SceneStore::load(const Document& document, const AssetSource& assets,
                                      const std::string& client) const {
  const std::stop_token* const stop = WorkScope::current().stop;
  return work_.open(client)->run(stop ? *stop : std::stop_token(), [&] {
    return std::make_shared<const PreparedScene>(load_scene(document, assets));
  });
}

SceneStore::Prepared SceneStore::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (const Entry* const known = find_locked(id)) return known->scene;
  throw NotFound("There is no scene " + id.substr(0, 64) + " (any more): post it again");
}

void SceneStore::remove(const std::string& id, const std::string& client, bool of_all) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) throw NotFound("There is no scene " + id.substr(0, 64));
  std::set<std::string>& keepers = known->second->keepers;
  if (keepers.erase(client) == 0 && !keepers.empty() && !of_all)
    throw HttpError(403, "Only who keeps the scene may remove it, or a token of the scope admin");
  if (keepers.empty() || of_all) erase(known->second);
}

void SceneStore::measure(const PreparedScene& scene) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(scene.scene().id);
  const bool here = known != by_id_.end();
  if (!here || known->second->scene.get() != &scene) return scene.settle(here, false);
  set_bytes(*known->second, scene.bytes());
  scene.settle(true, true);
  drop_cached(most_);
  drop_built(most_);
}

std::size_t SceneStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

SceneStore::Entry* SceneStore::find_locked(const std::string& id) {
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, known->second);
  return &*known->second;
}

std::size_t SceneStore::kept_bytes() const {
  std::size_t bytes = 0;
  for (const Entry& entry : entries_)
    if (!entry.keepers.empty()) bytes += entry.bytes;
  return bytes;
}

SceneStore::Prepared SceneStore::add(const Prepared& scene, const std::set<std::string>& keepers) {
  const std::size_t room = most_ - scene->loaded_bytes();
  drop_cached(room);
  if (!keepers.empty()) {
    drop_built(room);
    drop_kept(room);
  }
  entries_.push_front({scene, keepers});
  by_id_.emplace(scene->scene().id, entries_.begin());
  set_bytes(entries_.front(), scene->loaded_bytes());
  scene->settle(true, false);
  return scene;
}

void SceneStore::set_bytes(Entry& entry, std::size_t bytes) {
  bytes_ += bytes - entry.bytes;
  entry.bytes = bytes;
}

void SceneStore::erase(Entries::iterator entry) {
  set_bytes(*entry, 0);
  entry->scene->settle(false, false);
  by_id_.erase(entry->scene->scene().id);
  entries_.erase(entry);
}

void SceneStore::drop_cached(std::size_t most_bytes) {
  for (auto entry = entries_.end(); bytes_ > most_bytes && entry != entries_.begin();)
    if ((--entry)->keepers.empty()) ++evictions_, erase(entry++);
}

void SceneStore::drop_built(std::size_t most_bytes) {
  for (auto entry = entries_.end(); bytes_ > most_bytes && entry != entries_.begin();) {
    --entry;
    entry->scene->settle(true, false);
    entry->scene = entry->scene->without_built();
    set_bytes(*entry, entry->scene->loaded_bytes());
  }
}

void SceneStore::drop_kept(std::size_t most_bytes) {
  for (; bytes_ > most_bytes && !entries_.empty(); ++evictions_) erase(std::prev(entries_.end()));
}

}  // namespace orrery
