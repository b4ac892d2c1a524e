#pragma once

#include <cstddef>
#include <memory>

#include "tests/bench/rays.h"

// Embree 3 on one thread. Times are CPU seconds of that thread.
namespace orrery::bench {

class Embree {
 public:
  // Builds in high quality. `robust`: its watertight mode.
  Embree(const Mesh& mesh, bool robust);
  ~Embree();
  Embree(const Embree&) = delete;

  double build_s() const;
  std::size_t bytes() const;  // held after building

  double closest_in_packets(const RaySet& set) const;  // of 16, coherent
  // One by one. `found`: how many met something.
  double closest(const RaySet& set, std::size_t& found) const;
  double occluded(const RaySet& set, std::size_t& found) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery::bench
