#pragma once

#include "core/model/world.h"

namespace orrery {

// Returns the radiance that the surfaces of register i emit, or 0 in lanes that missed or do not emit.
// REQUIRES: the materials of the register are set, textures are evaluated, and geometry.emission is not
// empty.
template <class T>
Vec3<Lanes<T>> emission_at(const Geometry<T>& geometry, const SurfaceBatch<T>& surface, int i) {
  using N = Lanes<T>;
  const auto of = [&](IndexOf<T> material) {
    return material < 0 ? Vec3<T>() : geometry.emission[static_cast<std::size_t>(material)];
  };
  const auto is_textured = [&](IndexOf<T> material) {
    return material >= 0 && !geometry.has_textured_emission.empty() &&
           geometry.has_textured_emission[static_cast<std::size_t>(material)];
  };
  const IndexLanes<T> material = load_index<T>(surface.material, i);
  if (all(material == material[0]))
    return is_textured(material[0]) ? surface.emitted.at(i) : Vec3<N>(of(material[0]));
  Vec3<N> radiance;
  for (std::size_t lane = 0; lane < N::size(); ++lane) {
    const Vec3<T> one =
        is_textured(material[lane]) ? surface.emitted[i + static_cast<int>(lane)] : of(material[lane]);
    radiance.x[lane] = one.x;
    radiance.y[lane] = one.y;
    radiance.z[lane] = one.z;
  }
  return radiance;
}

// Adds the emitted radiance of the surfaces of `met` to `radiance`.
template <class T>
void add_emission(const Geometry<T>& geometry, const SurfaceBatch<T>& surface, const LaneGroups& met,
                  Vec3Array<T>& radiance) {
  if (geometry.emission.empty()) return;
  for (const int i : met) radiance.put(i, radiance.at(i) + emission_at(geometry, surface, i));
}

}  // namespace orrery
