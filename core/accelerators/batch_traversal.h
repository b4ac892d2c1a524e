#pragma once

#include "core/accelerators/stream.h"

namespace orrery {

// Traverses a tree with the rays of a batch. Registers of coherent rays are traversed as packets, other rays
// one by one.
template <class T>
class BatchTraversal {
 public:
  // `t` and `primitive` contain the nearest known hit of each ray: initially t_max and kNoPrimitive. Rays
  // with t <= 0 are inactive. For closest-hit queries, run() replaces both by the nearest hit. For occlusion
  // queries, `primitive` is null and run() sets t of occluded rays to -1. REQUIRES: all arguments outlive
  // this object.
  BatchTraversal(const WideTree<T>& tree, const RayBatch<T>& rays, const LaneGroups& groups, Array<T>& t,
                 Array<IndexOf<T>>* primitive)
      : tree_(tree), rays_(rays), groups_(groups), t_(t), primitive_(primitive) {}

  template <Query kQuery>
  void run(AcceleratorCounts& counts) {
    for (const int group : groups_) {
      add(rays_.at(group), group);
      if (trial_ == Trial::packets && packets_.count == kTrialPackets) try_packets<kQuery>(counts);
      if (trial_ == Trial::singles && singles_.count >= kTrialSingles) try_singles<kQuery>(counts);
    }
    run_packets<kQuery>(counts);
    run_singles<kQuery>(counts);
  }

 private:
  using N = Lanes<T>;
  // Maximum width of a packet at the box of the tree, relative to the mean leaf extent. Wider packets would
  // test many boxes that most of their rays miss.
  static constexpr T kMaxPacketExtent = 1;
  // Maximum number of block and primitive tests per packet. When a packet exceeds this budget, its rays
  // continue one by one.
  static constexpr int kPacketBudget = 200;
  // If the first kTrialPackets packets need more than kDearTests tests on average, the next kTrialSingles or
  // more rays are traced one by one. The remaining rays of the batch use the method with the lower cost per
  // ray. The costs below are in ns, measured on one machine. Only their ratios matter.
  static constexpr int kTrialPackets = 8, kTrialSingles = 2 * kWidth<T>, kDearTests = 48;
  static constexpr double kPacketCost = 100, kPacketVisitCost = 12, kPacketTestCost = 14;
  static constexpr double kSingleCost = 30, kSingleVisitCost = 9, kSingleTestCost = 3.5;
  enum class Trial { packets, singles, over };

  template <Query kQuery>
  void try_packets(AcceleratorCounts& counts) {
    const std::uint64_t before = counts.node_visits;
    const double tests = run_packets<kQuery>(counts);
    packet_cost_ = (kPacketCost * kTrialPackets + kPacketTestCost * tests +
                    kPacketVisitCost * static_cast<double>(counts.node_visits - before)) /
                   (kTrialPackets * kWidth<T>);
    packets_pay_ = tests <= kDearTests * kTrialPackets;
    trial_ = packets_pay_ ? Trial::over : Trial::singles;
    run_singles<kQuery>(counts);
  }

  template <Query kQuery>
  void try_singles(AcceleratorCounts& counts) {
    const AcceleratorCounts before = counts;
    const double rays = singles_.count;
    run_singles<kQuery>(counts);
    const double cost =
        kSingleCost * rays + kSingleVisitCost * static_cast<double>(counts.node_visits - before.node_visits) +
        kSingleTestCost * static_cast<double>(counts.primitive_tests - before.primitive_tests);
    packets_pay_ = packet_cost_ * rays < cost;
    trial_ = Trial::over;
  }

  // Traces all packets. Adds the active rays of packets that exceeded their budget to singles_. Returns the
  // number of block and primitive tests.
  template <Query kQuery>
  double run_packets(AcceleratorCounts& counts) {
    run_all<kQuery>(packets_, counts);
    double tests = 0;
    for (int i = 0; i < packets_.count; ++i) {
      const auto& hit = packets_.hits[i];
      const int group = packets_.place[i];
      t_.put(group, hit.t);
      if (primitive_) primitive_->put(group, hit.primitive);
      tests += kPacketBudget - hit.budget;
      if (hit.budget >= 0) continue;
      const auto& packet = packets_.rays[i];
      const unsigned all = ~0u;
      add_singles(packet.ray, packet.shear, packet.axis[2] == 0 ? all : 0, packet.axis[2] == 1 ? all : 0,
                  bits_of(hit.t > N(T(0))), group);
    }
    packets_.count = 0;
    return tests;
  }

  template <Query kQuery>
  void run_singles(AcceleratorCounts& counts) {
    run_all<kQuery>(singles_, counts);
    for (int i = 0; i < singles_.count; ++i) {
      t_[singles_.place[i]] = singles_.hits[i].t;
      if (primitive_) (*primitive_)[singles_.place[i]] = singles_.hits[i].primitive;
    }
    singles_.count = 0;
  }

  void add(const Ray<N>& ray, int group) {
    const auto active = t_.at(group) > N(T(0));
    if (!any(active)) return;
    const RayAxes<N> axes(ray.direction);
    const Shear<N> shear = Shear<N>::of(axes, ray.direction);
    const unsigned bits = bits_of(active), x = bits_of(axes.z_is_x), y = bits_of(axes.z_is_y);
    const unsigned any_x = x & bits, any_y = y & bits;
    const bool shared = (any_x == 0 || any_x == bits) && (any_y == 0 || any_y == bits);
    if (shared && packets_pay_) {
      const PacketBoxTester<T> probe(ray, active);
      const auto& axis = kCyclicAxes[any_x ? 0 : any_y ? 1 : 2];
      if (probe.narrow() && probe.width_at(tree_.box()) < kMaxPacketExtent * tree_.mean_leaf_extent())
        return add_packet(packet_of(ray, shear, axis, probe, active), probe, group);
    }
    add_singles(ray, shear, x, y, bits, group);
  }

  void add_packet(const Packet<T>& packet, const PacketBoxTester<T>& probe, int group) {
    const N t = t_.at(group);
    const auto primitive =
        primitive_ ? load_index<T>(*primitive_, group) : IndexLanes<T>(IndexOf<T>(kNoPrimitive));
    packets_.add(packet, probe, {t, primitive, stdx::hmax(t), kPacketBudget}, group);
  }

  // Adds the lanes of a register whose bits are set in `chosen` to singles_. Bits of `x` and `y` mark rays
  // whose largest direction component is x or y.
  void add_singles(const Ray<N>& ray, const Shear<N>& shear, unsigned x, unsigned y, unsigned chosen,
                   int group) {
    const typename RayBoxTester<T>::Register probes(ray);
    alignas(64) std::array<std::array<T, static_cast<std::size_t>(kWidth<T>)>, 9> row;
    const std::array<const N*, 9> from{&ray.origin.x,    &ray.origin.y,    &ray.origin.z,
                                       &ray.direction.x, &ray.direction.y, &ray.direction.z,
                                       &shear.x,         &shear.y,         &shear.z};
    for (std::size_t i = 0; i < from.size(); ++i) from[i]->copy_to(row[i].data(), stdx::vector_aligned);
    for (; chosen != 0; chosen &= chosen - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(chosen));
      const auto& axis = kCyclicAxes[x >> lane & 1u ? 0 : y >> lane & 1u ? 1 : 2];
      const int place = group + static_cast<int>(lane);
      const auto primitive = primitive_ ? (*primitive_)[place] : IndexOf<T>(kNoPrimitive);
      singles_.add({{{row[0][lane], row[1][lane], row[2][lane]}, {row[3][lane], row[4][lane], row[5][lane]}},
                    axis,
                    {row[6][lane], row[7][lane], row[8][lane]}},
                   RayBoxTester<T>(probes, lane), {t_[place], primitive}, place);
    }
  }

  static Packet<T> packet_of(const Ray<N>& ray, const Shear<N>& shear, const std::array<int, 3>& axis,
                             const PacketBoxTester<T>& probe, const MaskOf<N>& active) {
    if (!probe.one_origin()) return {ray, axis, shear, false, {}, {}, {}};
    return {ray,
            axis,
            shear,
            true,
            probe.origin(),
            {smallest(active, shear.x), smallest(active, shear.y)},
            {largest(active, shear.x), largest(active, shear.y)}};
  }

  // Runs all traversals, grouped by octant of the direction, because rays of one octant visit nodes in nearly
  // the same order.
  template <Query kQuery, class Traversals>
  void run_all(Traversals& traversals, AcceleratorCounts& counts) const {
    if (traversals.count == 0) return;
    using Streaming = Stream<kQuery, T, Traversals>;
    const auto octant = [&](int i) -> std::size_t { return traversals.probes[i].octant(); };
    std::array<int, 9> begin{};  // start of each octant in `ids`, then the end of the last octant
    for (int i = 0; i < traversals.count; ++i) ++begin[octant(i) + 1];
    for (std::size_t o = 0; o < 8; ++o) begin[o + 1] += begin[o];
    std::array<std::int32_t, Traversals::kCapacity + Streaming::kPad> ids;
    std::array<int, 9> next = begin;
    for (int i = 0; i < traversals.count; ++i) ids[static_cast<std::size_t>(next[octant(i)]++)] = i;
    Streaming stream(tree_, traversals, counts);
    for (std::size_t o = 0; o < 8; ++o)
      if (begin[o] < begin[o + 1]) stream.run(ids.data() + begin[o], begin[o + 1] - begin[o]);
  }

  const WideTree<T>& tree_;
  const RayBatch<T>& rays_;
  const LaneGroups& groups_;
  Array<T>& t_;
  Array<IndexOf<T>>* const primitive_;
  TraversalGroup<Packet<T>, PacketBoxTester<T>, PacketHit<T>, kBatch / kWidth<T>> packets_;
  TraversalGroup<SingleRay<T>, RayBoxTester<T>, SingleHit<T>, kBatch> singles_;
  Trial trial_ = Trial::packets;
  bool packets_pay_ = true;
  double packet_cost_ = 0;  // estimated ns per ray, from the trial of packets
};

}  // namespace orrery
