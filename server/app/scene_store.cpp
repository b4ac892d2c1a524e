#include "server/app/scene_store.h"

#include "core/base/error.h"

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

SceneStore::Added SceneStore::add(std::shared_ptr<const Scene> scene) {
  const std::size_t size = estimated_bytes(*scene);
  if (size > scenes_.most_bytes())
    throw InputError("", "the scene takes about " + std::to_string(size) + " bytes of memory, at most " +
                             std::to_string(scenes_.most_bytes()) + " are kept (store_bytes)");
  const auto added = scenes_.add(
      scene->id, size, [&scene] { return std::make_shared<const PreparedScene>(std::move(scene)); });
  return {added.value, added.known};
}

SceneStore::Prepared SceneStore::find(const std::string& id) {
  if (auto known = find_known(id)) return known;
  throw NotFound("There is no scene " + id.substr(0, 64) + " (any more): post it again");
}

SceneStore::Prepared SceneStore::find_known(const std::string& id) {
  return scenes_.find(id).value_or(nullptr);
}

void SceneStore::remove(const std::string& id) {
  if (!scenes_.remove(id)) throw NotFound("There is no scene " + id.substr(0, 64));
}

}  // namespace orrery
