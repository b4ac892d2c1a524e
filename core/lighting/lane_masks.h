#pragma once

#include "core/model/world.h"

namespace orrery {

// Returns the lanes of register i whose rays hit nothing, inactive rays included.
template <class T>
[[gnu::always_inline]] inline MaskOf<Lanes<T>> missed_lanes(const HitBatch<T>& hits, int i) {
  return mask_cast<Lanes<T>>(load_index<T>(hits.primitive, i) == IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
}

// Returns the registers of `groups` with a hit.
template <class T>
LaneGroups groups_with_hits(const HitBatch<T>& hits, const LaneGroups& groups) {
  LaneGroups met;
  for (const int i : groups)
    if (!all(missed_lanes(hits, i))) met.add(i);
  return met;
}

// Returns the lanes of register i whose material has the trait. REQUIRES: the register's materials are set.
template <class T>
MaskOf<Lanes<T>> lanes_with(const Geometry<T>& geometry, const SurfaceBatch<T>& surface, int i,
                            bool MaterialTraits::*trait) {
  const IndexLanes<T> material = load_index<T>(surface.material, i);
  typename Lanes<T>::mask_type lanes(false);
  for (const auto& m : geometry.materials)
    if (m.traits.*trait) lanes = lanes || mask_cast<Lanes<T>>(material >= m.first && material < m.last);
  return lanes;
}

// Returns the registers of `groups` in which lanes_with() is not empty.
template <class T>
LaneGroups groups_with(const Geometry<T>& geometry, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                       bool MaterialTraits::*trait) {
  LaneGroups chosen;
  for (const int i : groups)
    if (any(lanes_with(geometry, surface, i, trait))) chosen.add(i);
  return chosen;
}

}  // namespace orrery
