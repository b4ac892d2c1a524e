#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "server/app/orbit_cast.h"

namespace orrery {

// Registry of the orbits that have viewers. Safe from any thread.
class OrbitHub {
 public:
  OrbitHub(const RenderServices& services, int most_orbits, std::chrono::seconds frame_time)
      : services_(services), most_(most_orbits), frame_time_(frame_time) {}

  // Joins the viewers of an equal orbit, or starts a new one. Throws OverLimit if there are too many orbits,
  // ClientBusy if too many of them are this client's.
  std::unique_ptr<OrbitCast::Viewer> watch(const OrbitSpec& spec);

  std::size_t count();  // number of different orbits with viewers

 private:
  void forget_ended();  // REQUIRES: mutex_ is held

  const RenderServices services_;
  const int most_;
  const std::chrono::seconds frame_time_;
  std::mutex mutex_;
  std::list<std::weak_ptr<OrbitCast>> casts_;  // owned by their viewers
};

}  // namespace orrery
