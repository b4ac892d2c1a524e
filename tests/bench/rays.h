#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/model/batch.h"
#include "tests/bench/subject.h"

namespace orrery::bench {

// Rays of one kind, and their maximum distances.
struct RaySet {
  std::vector<Ray<float>> rays;
  std::vector<float> t_max;
  bool any_hit = false;  // search for any hit instead of the closest
};

// Closest hits with a mesh: triangle, or kNoPrimitive, and distance.
struct Hits {
  std::vector<int> triangle;
  std::vector<float> t;
};
using FindHits = std::function<Hits(const RaySet&)>;

// Returns the kinds of rays:
//   "primary": camera rays in blocks of 4 x 4 pixels
//   "bounce", "bounce-4": cosine-weighted directions after one bounce and after four bounces
//   "point", "area": any hit, from the points that the camera sees to a light
//   "short": any hit within half a radius, in cosine-weighted directions
std::span<const char* const> ray_kinds();

// Returns the rays of a kind. REQUIRES: `kind` is one of ray_kinds().
RaySet rays_of(const std::string& kind, const Subject& subject, const FindHits& find);

}  // namespace orrery::bench
