#include "server/rendering/orbit_registry.h"

#include "core/base/error.h"

namespace orrery {

std::unique_ptr<OrbitBroadcast::Viewer> OrbitRegistry::watch(const OrbitSpec& spec) {
  const std::lock_guard lock(mutex_);
  forget_ended();
  int own = 0;
  for (const auto& known : casts_) {
    const auto cast = known.lock();
    if (!cast) continue;
    if (cast->spec().key == spec.key)
      if (auto viewer = OrbitBroadcast::join(cast, spec.client)) return viewer;
    own += cast->is_watched_by(spec.client);
  }
  Quota{.noun = "orbit", .state = "streaming", .limit = "max_orbit_streams", .most = max_, .retry_s = 5}
      .require_one_more(static_cast<int>(casts_.size()), own);
  const auto cast = std::make_shared<OrbitBroadcast>(spec, services_);
  casts_.push_back(cast);
  return OrbitBroadcast::join(cast, spec.client);
}

void OrbitRegistry::forget_ended() {
  casts_.remove_if([](const auto& cast) { return cast.expired(); });
}

std::size_t OrbitRegistry::count() {
  const std::lock_guard lock(mutex_);
  forget_ended();
  return casts_.size();
}

}  // namespace orrery
