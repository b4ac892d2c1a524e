#include "core/model/channel.h"

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) value.put(i, first.surface.position.at(i));
}

}  // namespace

ChannelType position_channel() {
  return {"position",
          "Hit point of the camera ray, in metres.",
          {"X", "Y", "Z"},
          ChannelMean::of_hits,
          0,
          {},
          record<float>,
          record<double>};
}

}  // namespace orrery
