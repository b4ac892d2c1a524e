#include "server/app/scene_store.h"

#include "core/base/error.h"

namespace orrery {
namespace {

// What a scene and all that rendering builds for it are expected to take.
std::size_t estimated_bytes(const Scene& scene) {
  constexpr std::size_t kBytesAPrimitive = 1024;  // record, boxes and tree, in both precisions
  return 4096 + 2 * scene.canonical.size() +
         kBytesAPrimitive * static_cast<std::size_t>(scene.primitive_count());
}

}  // namespace

SceneStore::Added SceneStore::add(std::shared_ptr<const Scene> scene) {
  const std::size_t size = estimated_bytes(*scene);
  if (size > most_bytes_)
    throw InputError("", "the scene takes about " + std::to_string(size) + " bytes of memory, at most " +
                             std::to_string(most_bytes_) + " are kept (store_bytes)");
  const std::string id = scene->id;
  const std::lock_guard lock(mutex_);
  if (const auto known = entries_.find(id); known != entries_.end()) {
    touch(known->second);
    return {known->second.scene, true};
  }
  while (bytes_ + size > most_bytes_) {
    const auto oldest = entries_.find(uses_.back());
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
    uses_.pop_back();
  }
  uses_.push_front(id);
  bytes_ += size;
  const auto prepared = std::make_shared<const PreparedScene>(std::move(scene));
  entries_.emplace(id, Entry{prepared, size, uses_.begin()});
  return {prepared, false};
}

SceneStore::Prepared SceneStore::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(id);
  if (found == entries_.end())
    throw NotFound("There is no scene " + id.substr(0, 64) + " (any more): post it again");
  touch(found->second);
  return found->second.scene;
}

void SceneStore::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(id);
  if (found == entries_.end()) throw NotFound("There is no scene " + id.substr(0, 64));
  bytes_ -= found->second.bytes;
  uses_.erase(found->second.use);
  entries_.erase(found);
}

std::size_t SceneStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void SceneStore::touch(Entry& entry) { uses_.splice(uses_.begin(), uses_, entry.use); }

}  // namespace orrery
