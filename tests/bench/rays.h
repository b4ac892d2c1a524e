#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/model/batch.h"
#include "tests/bench/subject.h"

namespace orrery::bench {

// Rays of one kind, and how far each goes.
struct RaySet {
  std::vector<Ray<float>> rays;
  std::vector<float> t_max;
  bool any_hit = false;  // whether something is met, not what
};

// Where rays meet a mesh first: triangle, or kNoPrimitive, and distance.
struct Hits {
  std::vector<int> triangle;
  std::vector<float> t;
};
using FindHits = std::function<Hits(const RaySet&)>;

// The kinds: "primary", camera rays in blocks of 4 x 4 pixels; "bounce" and "bounce-4", cosine-weighted off
// the surface once and after four bounces; "point" and "area", any-hit to a light from what the camera sees;
// "short", any-hit within half a radius in cosine-weighted directions.
std::span<const char* const> ray_kinds();

// REQUIRES: `kind` is one of them.
RaySet rays_of(const std::string& kind, const Subject& subject, const FindHits& find);

}  // namespace orrery::bench
