#pragma once

#include <vector>

#include "core/model/path.h"

// Film channels other than radiance (AOVs): properties of the first hits of camera rays.
namespace orrery {

// Values of one channel for a batch of camera rays.
template <class T>
struct ChannelBatch {
  Vec3Array<T> value;  // valid only in the components of the channel
  Array<T> weight;     // 1 if the ray hit something, else 0
};

// Inputs of a channel: the first hits of camera rays.
template <class T>
struct FirstHits {
  const PathBatch<T>& paths;
  const HitBatch<T>& hits;
  const SurfaceBatch<T>& surface;
};

// Reduction of the samples of a pixel to one value.
enum class ChannelMean {
  of_hits,      // mean over the samples that hit something
  first_sample  // value of the first sample, for identifiers
};

struct ChannelType {
  const char* name;
  const char* summary;
  std::vector<const char*> components;  // 1 to 3 name suffixes, such as "X", "Y", "Z"
  ChannelMean mean;
  float nothing;         // value of a pixel in which every camera ray missed
  SurfaceFields fields;  // surface fields that `record` reads
  // Sets the components of the value for the registers of `groups`.
  void (*record_float)(const FirstHits<float>&, const LaneGroups&, Vec3Array<float>&);
  void (*record_double)(const FirstHits<double>&, const LaneGroups&, Vec3Array<double>&);

  template <class T>
  void record(const FirstHits<T>& first, const LaneGroups& groups, Vec3Array<T>& value) const {
    if constexpr (std::is_same_v<T, float>)
      record_float(first, groups, value);
    else
      record_double(first, groups, value);
  }
};

}  // namespace orrery
