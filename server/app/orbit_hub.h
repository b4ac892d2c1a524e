#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "server/app/orbit_cast.h"

namespace orrery {

// The orbits that are being watched. Safe from any thread.
class OrbitHub {
 public:
  OrbitHub(const RenderServices& services, int most_orbits, std::chrono::seconds frame_time)
      : services_(services), most_(most_orbits), frame_time_(frame_time) {}

  // Joins those who watch the same orbit, or starts it. Throws Busy if there are too many different ones,
  // ClientBusy if too many of them are this client's.
  std::unique_ptr<OrbitCast::Viewer> watch(const OrbitSpec& spec);

  std::size_t count();  // of different ones that are watched

 private:
  void forget_ended();  // with mutex_ held

  const RenderServices services_;
  const int most_;
  const std::chrono::seconds frame_time_;
  std::mutex mutex_;
  std::list<std::weak_ptr<OrbitCast>> casts_;  // their viewers own them
};

}  // namespace orrery
