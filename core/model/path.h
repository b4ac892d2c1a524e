#pragma once

#include "core/math/compress.h"
#include "core/model/batch.h"
#include "core/model/media.h"

namespace orrery {

// Rays of one depth. `slot` is the index of the camera ray that receives the light of a ray. The slot
// determines the pixel and, with the Draws of the batch, the sample.
template <class T>
struct PathBatch {
  RayBatch<T> rays;
  // Path throughput: factor from the ray's radiance to its share of the camera ray's radiance, per channel.
  Vec3Array<T> throughput;
  Array<IndexOf<T>> slot;
  // Pixel width in metres across the ray at its origin, and its growth per metre along the ray. Filled only
  // if the plan requires SurfaceFields::footprint.
  Array<T> width, spread;
  // Density per solid angle with which the ray's direction was sampled, or 0 for perfectly specular
  // directions. Filled only by techniques that sample directions. Not filled for camera rays.
  Array<T> pdf;
  std::unique_ptr<MediaLists> media;  // bodies that contain the rays; null unless Plan::media
  int depth = 0;                      // 0: camera rays

  // Appends the rays in the lanes `mask`, with throughput `weight`. Returns the mask as bits.
  unsigned append(const MaskOf<Lanes<T>>& mask, const Ray<Lanes<T>>& ray, const Vec3<Lanes<T>>& weight,
                  const IndexLanes<T>& slots) {
    const unsigned bits = bits_of(mask);
    const int n = rays.count;
    const auto pack = [&](Vec3Array<T>& to, const Vec3<Lanes<T>>& v) {
      compress_store(v.x, bits, &to.x[n]);
      compress_store(v.y, bits, &to.y[n]);
      compress_store(v.z, bits, &to.z[n]);
    };
    pack(rays.origin, ray.origin);
    pack(rays.direction, ray.direction);
    pack(throughput, weight);
    compress_store(slots, bits, &slot[n]);
    rays.count = n + std::popcount(bits);
    return bits;
  }
  // Sets the footprints of the rays that the last append() added. `bits` is the result of that call.
  void append_footprint(unsigned bits, const Lanes<T>& widths, const Lanes<T>& spreads) {
    const int n = rays.count - std::popcount(bits);
    compress_store(widths, bits, &width[n]);
    compress_store(spreads, bits, &spread[n]);
  }

  // Sets the densities of the rays that the last append() added. `bits` is the result of that call.
  void append_pdf(unsigned bits, const Lanes<T>& pdfs) {
    compress_store(pdfs, bits, &pdf[rays.count - std::popcount(bits)]);
  }

  // Sets t_max of every ray to infinity, and fills up the last register with inactive rays.
  void seal() {
    using N = Lanes<T>;
    for (int i = 0; i < rays.count; i += kWidth<T>) rays.t_max.put(i, N(std::numeric_limits<T>::infinity()));
    for (int i = rays.count; i % kWidth<T> != 0; ++i) {
      rays.t_max[i] = -1;
      rays.origin.x[i] = rays.origin.y[i] = rays.origin.z[i] = 0;
      rays.direction.x[i] = rays.direction.y[i] = rays.direction.z[i] = 1;
      throughput.x[i] = throughput.y[i] = throughput.z[i] = 0;
      slot[i] = 0;
      width[i] = spread[i] = pdf[i] = 0;
    }
  }

  // Appends the rays of `other` without `pdf`. Copies `width` and `spread` only if `footprints`. REQUIRES:
  // both batches together have at most kBatch rays.
  void append(const PathBatch& other, bool footprints) {
    const auto copy = [&](auto& to, const auto& from) {
      std::copy_n(from.values.begin(), other.rays.count, to.values.begin() + rays.count);
    };
    const auto copy3 = [&](Vec3Array<T>& to, const Vec3Array<T>& from) {
      copy(to.x, from.x);
      copy(to.y, from.y);
      copy(to.z, from.z);
    };
    copy3(rays.origin, other.rays.origin);
    copy3(rays.direction, other.rays.direction);
    copy3(throughput, other.throughput);
    copy(slot, other.slot);
    if (footprints) {
      copy(width, other.width);
      copy(spread, other.spread);
    }
    if (media) std::copy_n(other.media->begin(), other.rays.count, media->begin() + rays.count);
    rays.count += other.rays.count;
  }
};

}  // namespace orrery
