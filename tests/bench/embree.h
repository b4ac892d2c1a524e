#pragma once

#include <cstddef>
#include <memory>

#include "tests/bench/rays.h"

// Embree 3 on one thread. Times are CPU seconds of that thread.
namespace orrery::bench {

class Embree {
 public:
  // Builds in high quality. `robust`: Embree's watertight mode.
  Embree(const Mesh& mesh, bool robust);
  ~Embree();
  Embree(const Embree&) = delete;

  double build_s() const;
  std::size_t bytes() const;  // memory after building

  double closest_in_packets(const RaySet& set) const;  // packets of 16 coherent rays
  // Traces single rays. `found`: number of hits.
  double closest(const RaySet& set, std::size_t& found) const;
  double occluded(const RaySet& set, std::size_t& found) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery::bench
