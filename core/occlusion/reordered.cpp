#include "core/occlusion/reordered.h"

#include "core/math/compress.h"

namespace orrery {
namespace {

constexpr int kCellBits = 4;  // bits per axis; a key has 3 axes for the origin and 3 for the direction
constexpr int kCells = 1 << kCellBits;
constexpr int kDigitBits = 8, kDigits = 6 * kCellBits / kDigitBits;
static_assert(kDigits * kDigitBits == 6 * kCellBits);

using Keys = std::array<std::uint32_t, kBatch>;

// Returns (x - lo) * scale, clamped to [0, kCells - 1]. min_first and max_first ignore NaN, so every x has a
// cell.
template <class N>
auto cell_of(const N& x, const N& lo, const N& scale) {
  const N cell = min_first(N(kCells - 1), max_first(N(0), N((x - lo) * scale)));
  return stdx::static_simd_cast<IndexLanes<ScalarOf<N>>>(cell);
}

// Spreads bits: abcd becomes a00b00c00d.
template <class I>
I spread(I bits) {
  bits = (bits | bits << 4) & I(0x0c3);
  return (bits | bits << 2) & I(0x249);
}

template <class N>
auto morton(const Vec3<N>& v, const Vec3<N>& lo, const Vec3<N>& scale) {
  return spread(cell_of(v.x, lo.x, scale.x)) << 2 | spread(cell_of(v.y, lo.y, scale.y)) << 1 |
         spread(cell_of(v.z, lo.z, scale.z));
}

// Range of a coordinate over the active rays, without NaN.
template <class T>
struct Extent {
  using N = Lanes<T>;
  N lo = N(std::numeric_limits<T>::infinity()), hi = N(-std::numeric_limits<T>::infinity());

  void include(const MaskOf<N>& active, const N& x) {
    lo = min_first(lo, select(active, x, lo));
    hi = max_first(hi, select(active, x, hi));
  }
  T least() const { return stdx::hmin(lo); }
  // Returns the cells per metre, or 0 if the range is empty, a single value or infinite.
  T scale() const {
    const T size = stdx::hmax(hi) - least();
    return size > 0 ? T(kCells) / size : T(0);
  }
};

// Sets the sort keys of the active rays. Returns the places of these rays in the batch, in batch order.
template <class T>
RayOrder keys_of(const RayBatch<T>& rays, const LaneGroups& groups, Keys& keys) {
  using N = Lanes<T>;
  std::array<Extent<T>, 3> extent;
  for (const int i : groups) {
    const auto active = rays.t_max.at(i) > N(T(0));
    const Vec3<N> origin = rays.origin.at(i);
    extent[0].include(active, origin.x);
    extent[1].include(active, origin.y);
    extent[2].include(active, origin.z);
  }
  const Vec3<N> lo(N(extent[0].least()), N(extent[1].least()), N(extent[2].least()));
  const Vec3<N> scale(N(extent[0].scale()), N(extent[1].scale()), N(extent[2].scale()));
  const Vec3<N> unit_lo(N(T(-1))), unit_scale(N(T(kCells / 2)));
  RayOrder order;
  for (const int i : groups) {
    const auto key = morton(rays.origin.at(i), lo, scale) << 3 * kCellBits |
                     morton(rays.direction.at(i), unit_lo, unit_scale);
    for (unsigned bits = bits_of(rays.t_max.at(i) > N(T(0))); bits != 0; bits &= bits - 1) {
      const int lane = std::countr_zero(bits);
      const auto next = static_cast<std::size_t>(order.count++);
      keys[next] = static_cast<std::uint32_t>(key[static_cast<std::size_t>(lane)]);
      order.place[next] = static_cast<std::uint16_t>(i + lane);
    }
  }
  return order;
}

// Sorts by one digit. Stable.
void sort_by_digit(int digit, RayOrder& order, Keys& keys) {
  const auto digit_of = [&](std::uint32_t key) -> std::size_t {
    return key >> digit * kDigitBits & ((1u << kDigitBits) - 1);
  };
  const auto count = static_cast<std::size_t>(order.count);
  std::array<int, (1 << kDigitBits) + 1> next{};
  for (std::size_t i = 0; i < count; ++i) ++next[digit_of(keys[i]) + 1];
  if (next[digit_of(keys[0]) + 1] == order.count) return;
  for (std::size_t d = 1; d < next.size(); ++d) next[d] += next[d - 1];
  const RayOrder old_order = order;
  const Keys old_keys = keys;
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = static_cast<std::size_t>(next[digit_of(old_keys[i])]++);
    order.place[to] = old_order.place[i];
    keys[to] = old_keys[i];
  }
}

template <class T>
class RaySortingAccelerator final : public Accelerator<T> {
 public:
  RaySortingAccelerator(std::shared_ptr<const Accelerator<T>> behind, bool timed)
      : behind_(std::move(behind)), timed_(timed) {}

  AcceleratorFacts facts() const override { return behind_->facts(); }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    const RayOrder order = order_of(rays, groups);
    if (order.count == 0) return;
    RayBatch<T> sorted;
    HitBatch<T> found;
    const LaneGroups all = gather(rays, order, sorted);
    for (int to = 0; to < sorted.count; ++to) {
      const int from = place_of(order, to);
      found.t[to] = hits.t[from];
      found.primitive[to] = hits.primitive[from];
    }
    for (int i = sorted.count; i % kWidth<T> != 0; ++i) {
      found.t[i] = T(-1);
      found.primitive[i] = kNoPrimitive;
    }
    behind_->closest(sorted, all, found, counts);
    for (int from = 0; from < sorted.count; ++from) {
      hits.t[place_of(order, from)] = found.t[from];
      hits.primitive[place_of(order, from)] = found.primitive[from];
    }
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const RayOrder order = order_of(rays, groups);
    if (order.count == 0) return;
    RayBatch<T> sorted;
    behind_->occlude(sorted, gather(rays, order, sorted), counts);
    for (int from = 0; from < sorted.count; ++from) rays.t_max[place_of(order, from)] = sorted.t_max[from];
  }

 private:
  static int place_of(const RayOrder& order, int i) { return order.place[static_cast<std::size_t>(i)]; }

  // Copies the rays in `order` and fills the last register with inactive rays. Returns the registers.
  LaneGroups gather(const RayBatch<T>& rays, const RayOrder& order, RayBatch<T>& sorted) const {
    sorted.count = order.count;
    const LaneGroups all = LaneGroups::covering(0, order.count, kWidth<T>);
    for (int to = 0; to < all.size() * kWidth<T>; ++to) {
      const int from = place_of(order, std::min(to, order.count - 1));
      sorted.set(to, rays[from], to < order.count ? rays.t_max[from] : T(-1));
      if (timed_) sorted.time[to] = rays.time[from];
    }
    return all;
  }

  std::shared_ptr<const Accelerator<T>> behind_;
  const bool timed_;
};

}  // namespace

template <class T>
RayOrder order_of(const RayBatch<T>& rays, const LaneGroups& groups) {
  Keys keys;
  RayOrder order = keys_of(rays, groups, keys);
  if (order.count == 0) return order;
  for (int digit = 0; digit < kDigits; ++digit) sort_by_digit(digit, order, keys);
  return order;
}

template <class T>
std::shared_ptr<const Accelerator<T>> reordered(std::shared_ptr<const Accelerator<T>> behind, bool timed) {
  return std::make_shared<const RaySortingAccelerator<T>>(std::move(behind), timed);
}

template RayOrder order_of(const RayBatch<float>&, const LaneGroups&);
template RayOrder order_of(const RayBatch<double>&, const LaneGroups&);
template std::shared_ptr<const Accelerator<float>> reordered(std::shared_ptr<const Accelerator<float>>, bool);
template std::shared_ptr<const Accelerator<double>> reordered(std::shared_ptr<const Accelerator<double>>,
                                                              bool);

}  // namespace orrery
