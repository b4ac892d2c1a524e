#pragma once

#include "core/accelerators/stream.h"

namespace orrery {

// The rays of a batch on their way through a tree: registers of rays that run alike as packets, the others
// one by one.
template <class T>
class Walk {
 public:
  // `t`: the ends of the active rays, which become the distances of hits, or -1 where occluded.
  // `primitive`: of the hits, or null. REQUIRES: all outlive this.
  Walk(const RayBatch<T>& rays, const Groups& groups, Array<T>& t, Array<IndexOf<T>>* primitive)
      : t_(t), primitive_(primitive) {
    for (const int group : groups) add(rays.at(group), group);
  }

  template <Query kQuery>
  void run(const WideTree<T>& tree, AcceleratorCounts& counts) {
    run_all<kQuery>(tree, packets_, counts);
    run_all<kQuery>(tree, singles_, counts);
    for (int i = 0; i < packets_.count; ++i) {
      const PacketHit<T>& hit = packets_.hits[at(i)];
      t_.put(packets_.place[at(i)], hit.t);
      if (primitive_) primitive_->put(packets_.place[at(i)], hit.primitive);
    }
    for (int i = 0; i < singles_.count; ++i) {
      const SingleHit<T>& hit = singles_.hits[at(i)];
      t_[singles_.place[at(i)]] = hit.t;
      if (primitive_) (*primitive_)[singles_.place[at(i)]] = hit.primitive;
    }
  }

 private:
  using N = Lanes<T>;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  void add(const Ray<N>& ray, int group) {
    const auto active = t_.at(group) > N(T(0));
    if (!any(active)) return;
    const RayAxes<N> axes(ray.direction);
    const unsigned bits = bits_of(active), x = bits_of(axes.z_is_x), y = bits_of(axes.z_is_y);
    const unsigned any_x = x & bits, any_y = y & bits;
    const bool shared = (any_x == 0 || any_x == bits) && (any_y == 0 || any_y == bits);
    const PacketProbe<T> probe(ray, active);
    if (probe.narrow() && shared)
      add_packet(ray, axes, any_x ? 0 : any_y ? 1 : 2, probe, group);
    else
      add_singles(ray, axes, bits, group);
  }

  void add_packet(const Ray<N>& ray, const RayAxes<N>& axes, std::size_t z, const PacketProbe<T>& probe,
                  int group) {
    const N t = t_.at(group);
    const std::size_t i = at(packets_.count++);
    packets_.rays[i] = packet_of(ray, axes, z, t > N(T(0)));
    packets_.probes[i] = probe;
    packets_.hits[i] = {t, primitive_ ? load_index<T>(*primitive_, group) : IndexLanes<T>(kNoPrimitive),
                        stdx::hmax(t)};
    packets_.place[i] = group;
    packets_.octant[i] = probe.octant();
  }

  static Packet<T> packet_of(const Ray<N>& ray, const RayAxes<N>& axes, std::size_t z,
                             const MaskOf<N>& active) {
    const Shear<N> shear = Shear<N>::of(axes, ray.direction);
    const Vec3<T> origin(smallest(ray.origin.x, active), smallest(ray.origin.y, active),
                         smallest(ray.origin.z, active));
    const bool one_origin = !any(active && (ray.origin.x != N(origin.x) || ray.origin.y != N(origin.y) ||
                                            ray.origin.z != N(origin.z)));
    return {ray,
            kCyclicAxes[z],
            shear,
            one_origin,
            origin,
            {smallest(shear.x, active), smallest(shear.y, active)},
            {-smallest(-shear.x, active), -smallest(-shear.y, active)}};
  }
  static T smallest(const N& v, const MaskOf<N>& active) {
    return stdx::hmin(select(active, v, N(std::numeric_limits<T>::infinity())));
  }

  void add_singles(const Ray<N>& ray, const RayAxes<N>& axes, unsigned bits, int group) {
    const Shear<N> shear = Shear<N>::of(axes, ray.direction);
    const unsigned x = bits_of(axes.z_is_x), y = bits_of(axes.z_is_y);
    for (; bits != 0; bits &= bits - 1) {
      const int lane = std::countr_zero(bits);
      const std::size_t i = at(singles_.count++);
      const auto vector = [&](const Vec3<N>& v) {
        return Vec3<T>(v.x[at(lane)], v.y[at(lane)], v.z[at(lane)]);
      };
      const Ray<T> one{vector(ray.origin), vector(ray.direction)};
      const std::size_t z = x >> lane & 1u ? 0 : y >> lane & 1u ? 1 : 2;
      singles_.rays[i] = {one, kCyclicAxes[z], {shear.x[at(lane)], shear.y[at(lane)], shear.z[at(lane)]}};
      singles_.probes[i] = SingleProbe<T>(one);
      const int place = group + lane;
      singles_.hits[i] = {t_[place], primitive_ ? (*primitive_)[place] : IndexOf<T>(kNoPrimitive)};
      singles_.place[i] = place;
      singles_.octant[i] = singles_.probes[i].octant();
    }
  }

  // Those whose directions have the same signs agree about what is nearer: they go together.
  template <Query kQuery, class Walking>
  static void run_all(const WideTree<T>& tree, Walking& walkers, AcceleratorCounts& counts) {
    if (walkers.count == 0) return;
    std::array<int, 9> end{};
    for (int i = 0; i < walkers.count; ++i) ++end[walkers.octant[at(i)] + 1];
    for (std::size_t octant = 0; octant < 8; ++octant) end[octant + 1] += end[octant];
    std::array<int, 8> begin;
    std::copy(end.begin(), end.end() - 1, begin.begin());
    std::array<std::int32_t, kBatch> ids;
    std::array<int, 8> next = begin;
    for (int i = 0; i < walkers.count; ++i) ids[at(next[walkers.octant[at(i)]]++)] = i;
    Stream<kQuery, T, Walking> stream(tree, walkers, counts);
    for (std::size_t octant = 0; octant < 8; ++octant)
      if (begin[octant] < next[octant]) stream.run(ids.data() + begin[octant], next[octant] - begin[octant]);
  }

  Array<T>& t_;
  Array<IndexOf<T>>* const primitive_;
  Walkers<T, Packet<T>, PacketProbe<T>, PacketHit<T>, kBatch / kWidth<T>> packets_;
  Walkers<T, SingleRay<T>, SingleProbe<T>, SingleHit<T>, kBatch> singles_;
};

}  // namespace orrery
