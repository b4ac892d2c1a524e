#include "core/model/channel.h"

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) {
    const IndexLanes<T> object = load_index<T>(first.surface.object, i);
    value.x.put(i, stdx::static_simd_cast<Lanes<T>>(object + 1));
  }
}

}  // namespace

ChannelType object_channel() {
  return {"object",
          "Object number, counted from 1 in scene order; 0 if the ray misses.",
          {"Id"},
          ChannelMean::first_sample,
          0,
          {.identity = true},
          record<float>,
          record<double>};
}

}  // namespace orrery
