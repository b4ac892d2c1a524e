#include "core/prepare/prepared_scene.h"

#include <algorithm>
#include <mutex>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/prepare/geometry.h"

namespace orrery {
namespace {

template <class T>
using Moments = std::list<PreparedScene::Parts::Moment<T>>;

// Moves the moment of `exposure` to the front. If the moment is missing, adds it, and evicts the last moment
// if there are then more than kMoments.
template <class T>
void move_to_front(Moments<T>& moments, const Exposure& exposure) {
  const auto known =
      std::find_if(moments.begin(), moments.end(), [&](const auto& m) { return m.exposure == exposure; });
  if (known != moments.end()) return moments.splice(moments.begin(), moments, known);
  moments.push_front({exposure, {}, {}});
  if (moments.size() > PreparedScene::kMoments) moments.pop_back();
}

// Returns the most recently used world with this accelerator type among all moments but the first. Returns an
// empty world if there is none.
template <class T>
World<T> world_before(const Moments<T>& moments, const AcceleratorType& type) {
  for (auto moment = std::next(moments.begin()); moment != moments.end(); ++moment)
    if (const auto made = moment->worlds.find(&type); made != moment->worlds.end()) return made->second;
  return {};
}

// Opens a memory account for a build, with the source of the current account, and drops the accounts of
// evicted data. Returns null if memory is not counted.
std::shared_ptr<MemoryAccount> open_account(PreparedScene::Parts& parts) {
  const MemoryAccount* const client = TaskScope::current().memory;
  if (!client) return nullptr;
  const auto account = client->open_another();
  const TaskScope nobody({});
  const std::lock_guard lock(parts.accounts_mutex);
  std::erase_if(parts.built, [](const auto& some) { return some->bytes() == 0; });
  return parts.built.emplace_back(account);
}

}  // namespace

template <class T>
World<T> world_for(PreparedScene::Parts& parts, const AcceleratorType& type, const Exposure& exposure,
                   double& build_ms, std::stop_token stop) {
  const auto lock = lock_unless(parts.mutex, stop);
  auto& moments = made_of<T>(parts).moments;
  move_to_front(moments, exposure);
  auto& moment = moments.front();
  World<T>& world = moment.worlds[&type];
  if (world.accelerator) return world;
  const auto start = Clock::now();
  const auto make = [&] {
    const World<T> before = world_before(moments, type);
    auto& geometry = moment.geometries[parts.scene->models.empty() ? nullptr : &type];
    if (!geometry) geometry = make_geometry<T>(parts.scene, type, exposure, before.geometry.get());
    world = {geometry, build_or_refit(type, geometry->primitives, before.accelerator.get())};
  };
  const auto memory = open_account(parts);
  const TaskScope scope({nullptr, &stop});  // no time slice, because the owner of the mutex must not yield
  if (memory)
    memory->run(stop, make);
  else
    make();
  build_ms += milliseconds_since(start);
  return world;
}

template World<float> world_for(PreparedScene::Parts&, const AcceleratorType&, const Exposure&, double&,
                                std::stop_token);
template World<double> world_for(PreparedScene::Parts&, const AcceleratorType&, const Exposure&, double&,
                                 std::stop_token);

std::unique_lock<StoppableMutex> lock_unless(StoppableMutex& mutex, const std::stop_token& stop) {
  if (!mutex.lock_unless(stop)) throw Cancelled();
  return {mutex, std::adopt_lock};
}

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
  if (MemoryAccount* const memory = TaskScope::current().memory) {
    parts_->loaded = memory->shared_from_this();
    parts_->loaded_bytes = memory->bytes();
  }
}
PreparedScene::~PreparedScene() = default;

std::shared_ptr<const PreparedScene> PreparedScene::without_built() const {
  const auto fresh = std::make_shared<PreparedScene>(parts_->scene);
  fresh->parts_->loaded = parts_->loaded;
  fresh->parts_->loaded_bytes = parts_->loaded_bytes;
  return fresh;
}

std::size_t PreparedScene::loaded_bytes() const { return parts_->loaded_bytes; }

std::size_t PreparedScene::bytes() const {
  std::size_t bytes = parts_->loaded_bytes;
  const std::lock_guard lock(parts_->accounts_mutex);
  for (const auto& account : parts_->built) bytes += account->bytes();
  return bytes;
}

void PreparedScene::settle(bool loaded, bool built) const {
  if (parts_->loaded) parts_->loaded->settle(loaded ? parts_->loaded->bytes() : 0);
  const std::lock_guard lock(parts_->accounts_mutex);
  for (const auto& account : parts_->built) account->settle(built ? account->bytes() : 0);
}

const Scene& PreparedScene::scene() const { return *parts_->scene; }
std::shared_ptr<const Scene> PreparedScene::shared_scene() const { return parts_->scene; }

}  // namespace orrery
