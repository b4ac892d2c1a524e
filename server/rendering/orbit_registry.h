#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "server/rendering/orbit_broadcast.h"

namespace orrery {

// Registry of the orbits that have viewers. Thread-safe.
class OrbitRegistry {
 public:
  OrbitRegistry(const RenderServices& services, int max_orbits) : services_(services), max_(max_orbits) {}

  // Adds a viewer to an orbit with the same key, or to a new orbit. Throws LimitExceeded if there are too
  // many orbits, or ClientLimitExceeded if the client watches too many of them.
  std::unique_ptr<OrbitBroadcast::Viewer> watch(const OrbitSpec& spec);

  std::size_t count();  // number of distinct orbits with viewers

 private:
  void forget_ended();  // REQUIRES: mutex_ is held

  const RenderServices services_;
  const int max_;
  std::mutex mutex_;
  std::list<std::weak_ptr<OrbitBroadcast>> casts_;  // owned by their viewers
};

}  // namespace orrery
