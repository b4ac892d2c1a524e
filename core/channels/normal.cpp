#include "core/model/channel.h"

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) value.put(i, first.surface.normal.at(i));
}

}  // namespace

ChannelType normal_channel() {
  return {"normal",
          "Unit shading normal that faces the camera, in scene coordinates.",
          {"X", "Y", "Z"},
          ChannelMean::of_hits,
          0,
          {},
          record<float>,
          record<double>};
}

}  // namespace orrery
