#pragma once

#include <array>

#include "core/math/sampling.h"
#include "core/model/tile.h"

namespace orrery {

// Purpose of a pair of random numbers. Each purpose has a separate sequence at each depth.
enum class SampleSet : std::uint32_t {
  pixel,
  light,
  lobe,
  light_choice,
  survival,
  emission_ray,
  lens,
  emission_ray_lens,
  environment = 1u << 16  // exceeds the sequence numbers of all other sets at all depths
};
inline constexpr std::uint32_t kSampleSets = 8;  // number of sets before `environment`

// Purpose of a pair of random numbers of one scattering event inside a medium.
enum class EventSet : std::uint32_t { distance, direction, survival };
inline constexpr std::uint32_t kFirstEvent = 1u << 31;  // exceeds the sequence numbers of all SampleSets

// Random numbers of one sample of a tile. The numbers are pure functions of (seed, frame, x, y, sample, set,
// depth). They do not depend on tile order, threads or SIMD width.
class Draws {
 public:
  Draws(std::uint64_t seed, const TileView& tile, int sample)
      : seed_(combine_bits(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32))),
        frame_(static_cast<std::uint32_t>(tile.frame)),
        first_pixel_(static_cast<std::uint32_t>(tile.y0 * kRow + tile.x0)),
        sample_(static_cast<std::uint32_t>(sample)) {}

  template <class T>
  using Bits = stdx::rebind_simd_t<std::uint32_t, Lanes<T>>;

  // Returns two numbers in [0, 1) for the path of each slot (index of its camera ray in the tile) at `depth`
  // (0: camera rays).
  template <class T>
  [[gnu::always_inline]] SamplePoint<Lanes<T>> two(SampleSet set, int depth,
                                                   const IndexLanes<T>& slot) const {
    const auto point = stratified_point(sample_, stream<T>(set, depth, slot));
    return {stdx::static_simd_cast<Lanes<T>>(point.u), stdx::static_simd_cast<Lanes<T>>(point.v)};
  }

  // Returns two numbers for event `event` on the way to the vertex at `depth`, for the path of each slot.
  // REQUIRES: 0 <= event < 2^20 and depth < 2^8.
  template <class T>
  [[gnu::always_inline]] SamplePoint<Lanes<T>> two(EventSet set, int depth, const IndexLanes<T>& slot,
                                                   const IndexLanes<T>& event) const {
    const std::uint32_t place =
        kFirstEvent + 4 * static_cast<std::uint32_t>(depth) + static_cast<std::uint32_t>(set);
    const Bits<T> number = place + (stdx::static_simd_cast<Bits<T>>(event) << 10);
    const Bits<T> pixel = combine_bits(seed_, pixel_of(stdx::static_simd_cast<Bits<T>>(slot)));
    const Bits<T> stream = mix_bits<Bits<T>>(combine_bits<Bits<T>>(frame_, number) ^ pixel);
    const auto point = stratified_point(sample_, stream);
    return {stdx::static_simd_cast<Lanes<T>>(point.u), stdx::static_simd_cast<Lanes<T>>(point.v)};
  }

  // Returns a third number for each slot, stratified together with the two numbers of two().
  template <class T>
  [[gnu::always_inline]] Lanes<T> third(SampleSet set, int depth, const IndexLanes<T>& slot) const {
    return stdx::static_simd_cast<Lanes<T>>(stratified_third(sample_, stream<T>(set, depth, slot)));
  }

  // Fills `keys` with one random number per slot. Sorting by key gives a random order of the slots for this
  // sample.
  void shuffle_keys(std::array<std::uint32_t, kBatch>& keys) const {
    for (std::uint32_t slot = 0; slot < keys.size(); ++slot)
      keys[slot] = combine_bits<std::uint32_t>(
          combine_bits<std::uint32_t>(sample_, combine_bits<std::uint32_t>(frame_, seed_ ^ 0x5bd1e995u)),
          pixel_of(slot));
  }

  // Returns the streams that two() passes to stratified_point(). The streams are the same for every sample.
  template <class T>
  [[gnu::always_inline]] Bits<T> stream(SampleSet set, int depth, const IndexLanes<T>& slot) const {
    const std::uint32_t number =
        static_cast<std::uint32_t>(set) + kSampleSets * static_cast<std::uint32_t>(depth);
    const Bits<T> stream = combine_bits(seed_, pixel_of(stdx::static_simd_cast<Bits<T>>(slot)));
    if (number == 0 && frame_ == 0) return stream;
    return combine_bits(combine_bits(frame_, number), stream);
  }

 private:
  static constexpr int kRow = 65536;  // pixel number = kRow * y + x

  // Returns the pixel number of a slot: see tile_pixel().
  template <class N>
  [[gnu::always_inline]] N pixel_of(const N& slot) const {
    const N block = slot >> 4, within = slot & 15u;
    constexpr std::uint32_t kBlocks = kTileSide / 4;
    const N x = ((block & (kBlocks - 1)) << 2) + (within & 3u), y = ((block >> 3) << 2) + (within >> 2);
    static_assert(kBlocks == 8);
    return first_pixel_ + (y << 16) + x;
  }

  std::uint32_t seed_, frame_, first_pixel_, sample_;
};

// Random numbers of the paths of a batch. two() returns two numbers for each path of the register that starts
// at path i.
template <class T>
struct PathDraws {
  const Draws& draws;
  const Array<IndexOf<T>>& slot;
  int depth;

  [[gnu::always_inline]] SamplePoint<Lanes<T>> two(SampleSet set, int i) const {
    return draws.two<T>(set, depth, load_index<T>(slot, i));
  }
};

}  // namespace orrery
