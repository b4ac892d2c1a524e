#include "server/app/scene_store.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/load/load.h"

namespace orrery {
namespace {

// What a scene and all that rendering builds for it are expected to take.
std::size_t estimated_bytes(const Scene& scene) {
  constexpr std::size_t kBytesAPrimitive = 1024;  // record, boxes and tree, in both precisions
  std::size_t primitives = scene.instances.size(), others = 0;
  const auto count = [&](const std::vector<std::unique_ptr<ShapeSet>>& sets) {
    primitives += count_primitives(sets);
    for (const auto& shapes : sets) others += shapes->bytes();
  };
  count(scene.shapes);
  for (const Model& model : scene.models) count(model.shapes);
  std::size_t keys = 0;
  for (const Instance& instance : scene.instances) keys += instance.motion.times.size();
  const std::size_t moments = scene.motion.empty() ? 1 : PreparedScene::kMoments;
  return 4096 + 2 * scene.canonical.size() + moments * kBytesAPrimitive * primitives + 2 * others +
         keys * (sizeof(Placement) + sizeof(double)) + 3 * sizeof(std::int64_t) * scene.material_of.size();
}

}  // namespace

SceneStore::Kept SceneStore::keep(const Document& document, const MeshSource& meshes) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, meshes);
  const std::size_t size = estimated_bytes(scene->scene()), most = kept_.most_bytes();
  if (size > most)
    throw InputError("", "the scene takes about " + std::to_string(size) + " bytes of memory, at most " +
                             std::to_string(most) + " are kept (store_bytes)");
  const std::lock_guard lock(mutex_);
  cached_.remove(id);
  if (const auto known = kept_.find(id)) return {*known, true};
  cached_.shrink(most - std::min(most, kept_.bytes() + size));
  return {kept_.add(id, size, [&scene] { return scene; }).value, false};
}

SceneStore::Prepared SceneStore::get(const Document& document, const MeshSource& meshes) {
  const std::string id = document.id();
  const Prepared scene = find_or_load(id, document, meshes);
  const std::size_t size = estimated_bytes(scene->scene());
  const std::lock_guard lock(mutex_);
  if (const auto known = find_locked(id)) return known;
  const std::size_t room = kept_.most_bytes() - kept_.bytes();
  if (size > room) return scene;
  cached_.shrink(room - size);
  return cached_.add(id, size, [&scene] { return scene; }).value;
}

SceneStore::Prepared SceneStore::find_or_load(const std::string& id, const Document& document,
                                              const MeshSource& meshes) {
  if (auto known = find_known(id)) {
    ++hits_;
    return known;
  }
  auto loaded = std::make_shared<const PreparedScene>(load_scene(document, meshes));
  ++loads_;
  return loaded;
}

SceneStore::Prepared SceneStore::find_known(const std::string& id) {
  const std::lock_guard lock(mutex_);
  return find_locked(id);
}

SceneStore::Prepared SceneStore::find_locked(const std::string& id) {
  if (const auto kept = kept_.find(id)) return *kept;
  return cached_.find(id).value_or(nullptr);
}

SceneStore::Prepared SceneStore::find(const std::string& id) {
  if (auto known = find_known(id)) return known;
  throw NotFound("There is no scene " + id.substr(0, 64) + " (any more): post it again");
}

void SceneStore::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (!kept_.remove(id) && !cached_.remove(id)) throw NotFound("There is no scene " + id.substr(0, 64));
}

}  // namespace orrery
