#include "core/model/channel.h"

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) value.x.put(i, first.surface.footprint.at(i));
}

}  // namespace

ChannelType footprint_channel() {
  return {"footprint",
          "Width of a pixel at the hit point, perpendicular to the ray, in metres.",
          {"R"},
          ChannelMean::of_hits,
          0,
          {.footprint = true},
          record<float>,
          record<double>};
}

}  // namespace orrery
