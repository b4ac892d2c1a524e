#include "core/model/channel.h"

namespace orrery {
namespace {

template <class T>
void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) {
  for (const int i : groups) {
    value.x.put(i, first.surface.u.at(i));
    value.y.put(i, first.surface.v.at(i));
  }
}

}  // namespace

ChannelType uv_channel() {
  return {"uv",
          "Texture coordinates at the hit point.",
          {"U", "V"},
          ChannelMean::of_hits,
          0,
          {.parameters = true},
          record<float>,
          record<double>};
}

}  // namespace orrery
