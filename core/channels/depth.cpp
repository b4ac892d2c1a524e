#include "core/model/channel.h"

#include <limits>

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) value.x.put(i, first.hits.t.at(i));
}

}  // namespace

ChannelType depth_channel() {
  return {"depth",
          "Distance from the camera along the ray, in metres.",
          {"Z"},
          ChannelMean::of_hits,
          std::numeric_limits<float>::infinity(),
          {},
          record<float>,
          record<double>};
}

}  // namespace orrery
