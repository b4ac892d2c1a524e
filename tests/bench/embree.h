#pragma once

#include <cstddef>
#include <memory>

#include "tests/bench/rays.h"

// Embree 3 on one thread. Times are CPU seconds of this thread.
namespace orrery::bench {

class Embree {
 public:
  // Builds with high quality. `robust` selects Embree's watertight mode.
  Embree(const Mesh& mesh, bool robust);
  ~Embree();
  Embree(const Embree&) = delete;

  double build_s() const;
  std::size_t bytes() const;  // memory of the structure

  double closest_in_packets(const RaySet& set) const;  // packets of 16 coherent rays
  // Traces single rays. Sets `found` to the number of hits.
  double closest(const RaySet& set, std::size_t& found) const;
  double occluded(const RaySet& set, std::size_t& found) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace orrery::bench
