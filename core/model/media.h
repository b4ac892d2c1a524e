#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/math/bounds.h"
#include "core/math/elementary.h"
#include "core/model/batch.h"

namespace orrery {

// Optical properties of the inside of a body.
struct Medium {
  double ior = 1;             // index of refraction; air: 1
  double priority = 0;        // a body displaces overlapping bodies of lower priority
  Vec3d log2_filter;          // log2 of the transmittance per metre
  bool refracts_only = true;  // the surface does nothing but reflect and refract
  Vec3d albedo;               // scattered fraction of the light that the medium takes from a ray
  double anisotropy = 0;      // mean cosine of the angle of scattering (Henyey-Greenstein)

  bool scatters() const { return albedo != Vec3d(0); }
};

// Returns the transmittance of `distance` metres of a medium with this Medium::log2_filter.
template <class N>
[[gnu::always_inline]] inline Vec3<N> transmittance_of(const Vec3<N>& log2_filter, const N& distance) {
  return {exp2_flushed(log2_filter.x * distance), exp2_flushed(log2_filter.y * distance),
          exp2_flushed(log2_filter.z * distance)};
}

// Surfaces with a medium on one side. A body is one closed shape, a watertight mesh, or the half-space below
// a plane. Open surfaces have a medium too, but rays that pass them stay in the media that they were in.
struct Media {
  std::vector<Medium> bodies;
  std::vector<char> closed;                // by body: whether rays enter and leave it
  std::vector<Boundsd> bounds;             // by body, over its whole motion
  std::vector<std::int32_t> body_of;       // by primitive: index in `bodies`, or -1
  std::vector<std::int32_t> primitive_of;  // by body: its first primitive
  // By body: other bodies that may have a face in the same place. Both are single shapes outside instances.
  std::vector<std::vector<std::int32_t>> touching;
  // First two objects whose bounds overlap. Both empty if media are followed only because bodies scatter.
  std::string where, other;
  std::string scattering;  // first object with a closed body that scatters light, or empty

  // Returns whether rays must know the bodies that they are inside of.
  bool nested() const { return !bodies.empty(); }
  bool scatters() const { return !scattering.empty(); }
  // Returns whether rays outside all bodies may pass into one without reflection or refraction.
  bool like_air() const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (closed[i] != 0 && bodies[i].refracts_only && bodies[i].ior == 1) return true;
    return false;
  }
};

// Bodies that contain a point, in the order in which they were entered. The medium at the point is that of
// the body with the highest priority, and of the body entered last if priorities are equal (Schmidt, Budge,
// "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2), 2002). Stores at most
// kMax bodies: entering another one drops the first.
class MediaList {
 public:
  static constexpr int kMax = 16;

  bool empty() const { return count_ == 0; }
  bool contains(std::int32_t body) const { return std::find(begin(), end(), body) != end(); }
  void enter(std::int32_t body) {
    if (contains(body)) return;
    if (count_ == kMax) leave(bodies_[0]);
    bodies_[static_cast<std::size_t>(count_++)] = body;
  }
  void leave(std::int32_t body) {
    const auto found = std::find(begin(), end(), body);
    if (found == end()) return;
    std::copy(found + 1, end(), bodies_.begin() + (found - begin()));
    --count_;
  }
  // Returns the body whose medium the point is in, or -1 outside all bodies.
  std::int32_t top(const std::vector<Medium>& media) const {
    std::int32_t best = -1;
    const auto priority = [&](std::int32_t body) { return media[static_cast<std::size_t>(body)].priority; };
    for (const std::int32_t body : *this)
      if (best < 0 || priority(body) >= priority(best)) best = body;
    return best;
  }

  const std::int32_t* begin() const { return bodies_.data(); }
  const std::int32_t* end() const { return bodies_.data() + count_; }

 private:
  std::int32_t count_ = 0;
  std::array<std::int32_t, kMax> bodies_;
};

// Largest number of scattering events between two surfaces of a path. Light of longer walks is omitted.
inline constexpr int kMaxScatterings = 4096;

}  // namespace orrery
