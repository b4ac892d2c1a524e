#include "server/app/orbit_hub.h"

#include "core/base/error.h"

namespace orrery {

std::unique_ptr<OrbitCast::Viewer> OrbitHub::watch(const OrbitSpec& spec) {
  const std::lock_guard lock(mutex_);
  forget_ended();
  for (const auto& known : casts_) {
    const auto cast = known.lock();
    if (!cast || cast->spec().key != spec.key) continue;
    if (auto viewer = OrbitCast::join(cast)) return viewer;
  }
  if (static_cast<int>(casts_.size()) >= most_)
    throw Busy(std::to_string(casts_.size()) + " orbits are being watched already (orbits)", 5);
  const auto cast = std::make_shared<OrbitCast>(spec, means_, frame_time_);
  casts_.push_back(cast);
  return OrbitCast::join(cast);
}

void OrbitHub::forget_ended() {
  casts_.remove_if([](const auto& cast) { return cast.expired(); });
}

std::size_t OrbitHub::count() {
  const std::lock_guard lock(mutex_);
  forget_ended();
  return casts_.size();
}

void OrbitHub::wake() {
  const std::lock_guard lock(mutex_);
  for (const auto& known : casts_)
    if (const auto cast = known.lock()) cast->wake();
}

}  // namespace orrery
