#pragma once

#include "core/math/hemisphere.h"
#include "core/shapes/bezier_hit.h"
#include "core/shapes/primitive_set.h"

namespace orrery {

// Position and derivatives of a piece at the parameters (u, v) of the piece, relative to its origin.
template <class N>
struct BezierPoint {
  Vec3<N> position, du, dv;
};

template <class N, class T>
BezierPoint<N> bezier_point(const BezierPiece<T>& piece, const T* net, const N& u, const N& v) {
  const std::size_t size = piece.degrees.size();
  const auto at = [&](std::size_t i) { return evaluate_net<N>(net + i * size, piece.degrees, u, v); };
  const NetValue<N> x = at(0), y = at(1), z = at(2);
  BezierPoint<N> point{{x.value, y.value, z.value}, {x.du, y.du, z.du}, {x.dv, y.dv, z.dv}};
  if (!piece.rational) return point;
  const NetValue<N> w = at(3);
  const N inverse = T(1) / w.value;
  point.position = point.position * inverse;
  point.du = (point.du - point.position * w.du) * inverse;
  point.dv = (point.dv - point.position * w.dv) * inverse;
  return point;
}

// Returns the unit normal along du x dv. An edge that is collapsed to a point has a du or
// dv of 0. Within sqrt(epsilon) of such a place, returns the normal at this distance toward the centre.
template <class N, class T>
Vec3<N> bezier_normal(const BezierPiece<T>& piece, const T* net, const N& u, const N& v,
                      const BezierPoint<N>& point) {
  const T small = std::sqrt(std::numeric_limits<T>::epsilon());
  const auto direction = [](const BezierPoint<N>& at) { return cross(at.du, at.dv); };
  Vec3<N> normal = direction(point);
  const auto degenerate = !(dot(normal, normal) >
                            N(small * piece.radius * piece.radius) * N(small * piece.radius * piece.radius));
  if (any(degenerate)) {
    const N inner_u = u + (N(T(0.5)) - u) * (4 * small), inner_v = v + (N(T(0.5)) - v) * (4 * small);
    const Vec3<N> inner = direction(bezier_point<N, T>(piece, net, inner_u, inner_v));
    normal = select(degenerate, inner, normal);
  }
  const auto none = !(dot(normal, normal) > N(T(0)));
  return select(none, Vec3<N>(N(T(0)), N(T(0)), N(T(1))), normalize(normal));
}

// Pieces of Bezier patches, packed as indices of a shared table.
template <class T>
class PackedBezier final : public PackedPrimitives<T> {
 public:
  using RayBlockPairs = typename PackedPrimitives<T>::RayBlockPairs;
  using N = Lanes<T>;

  PackedBezier(std::shared_ptr<const BezierTable<T>> table, int first, std::span<const int> indices)
      : table_(std::move(table)), first_(first), indices_(indices.begin(), indices.end()) {}

  void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
               AcceleratorCounts& counts) const override {
    for (const RayBlockPair& pair : pairs)
      for_each_piece(pair.block, [&](std::size_t index) {
        SingleHit<T>& hit = hits[pair.ray];
        ++counts.primitive_tests;
        const T t = distance<T>(index, rays[pair.ray].ray);
        const auto id = static_cast<IndexOf<T>>(first_ + static_cast<int>(index));
        const bool lower = id < hit.primitive || hit.primitive == kNoPrimitive;
        if (t < hit.t || (t == hit.t && lower && std::isfinite(t))) hit = {t, id};
      });
  }

  void occlude(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
               AcceleratorCounts& counts) const override {
    for (const RayBlockPair& pair : pairs)
      for_each_piece(pair.block, [&](std::size_t index) {
        SingleHit<T>& hit = hits[pair.ray];
        if (hit.t < 0) return;
        ++counts.primitive_tests;
        if (distance<T>(index, rays[pair.ray].ray) < hit.t) hit.t = T(-1);
      });
  }

  void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    for_each_packet(pairs, packets, hits, counts, [&](std::size_t index, const N& t, PacketHit<T>& hit) {
      const IndexLanes<T> id(static_cast<IndexOf<T>>(first_ + static_cast<int>(index)));
      const auto nearer = is_nearer_hit(t, id, hit.t, hit.primitive);
      stdx::where(nearer, hit.t) = t;
      stdx::where(mask_cast<IndexLanes<T>>(nearer), hit.primitive) = id;
    });
  }

  void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    for_each_packet(pairs, packets, hits, counts, [](std::size_t, const N& t, PacketHit<T>& hit) {
      stdx::where(t < hit.t, hit.t) = N(T(-1));
    });
  }

  std::size_t bytes() const override { return indices_.size() * sizeof(int); }
  std::vector<int> indices() const override { return indices_; }

 private:
  static constexpr std::size_t kSize = static_cast<std::size_t>(kBlock<T>);

  template <class Visit>
  void for_each_piece(std::uint32_t block, const Visit& visit) const {
    for (std::size_t place = block * kSize; place < (block + 1) * kSize; ++place)
      if (indices_[place] != kNothing) visit(static_cast<std::size_t>(indices_[place]));
  }
  template <class M>
  M distance(std::size_t index, const Ray<M>& ray) const {
    return BezierRays<M>(table_->pieces[index], table_->net(index), ray).hit().t;
  }
  // Calls visit(piece, distances, hit) for each packet and piece.
  template <class Visit>
  void for_each_packet(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                       AcceleratorCounts& counts, const Visit& visit) const {
    for (const RayBlockPair& pair : pairs) {
      PacketHit<T>& hit = hits[pair.ray];
      if (hit.farthest < 0) continue;
      --hit.budget;
      for_each_piece(pair.block, [&](std::size_t index) {
        counts.primitive_tests += static_cast<std::uint64_t>(stdx::popcount(hit.t > N(T(0))));
        --hit.budget;
        visit(index, distance<N>(index, packets[pair.ray].ray), hit);
      });
      hit.farthest = stdx::hmax(hit.t);
    }
  }

  std::shared_ptr<const BezierTable<T>> table_;
  int first_;
  std::vector<int> indices_;
};

// Kernel of pieces of Bezier patches. Hits store no (u, v): surface() and parameters() intersect the hit
// piece again, once per ray.
template <class T>
class BezierKernel final : public ShapeKernel<T> {
 public:
  using N = Lanes<T>;

  BezierKernel(std::shared_ptr<const BezierTable<T>> table, int first)
      : table_(std::move(table)), first_(first) {}

  void closest(int index, const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts&) const override {
    const IndexLanes<T> id(static_cast<IndexOf<T>>(first_ + index));
    for (const int i : groups) {
      const N best = hits.t.at(i), t = hit(static_cast<std::size_t>(index), rays.at(i)).t;
      const auto nearer = is_nearer_hit(t, id, best, load_index<T>(hits.primitive, i));
      hits.t.put(i, nearer, t);
      hits.primitive.put(i, mask_cast<IndexLanes<T>>(nearer), id);
    }
  }

  void occlude(int index, RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts&) const override {
    for (const int i : groups) {
      const auto met = hit(static_cast<std::size_t>(index), rays.at(i)).t < rays.t_max.at(i);
      rays.t_max.put(i, met, N(-1));
    }
  }

  std::vector<HullTriangle> hull(int index) const override {
    const BezierPiece<T>& piece = table_->pieces[static_cast<std::size_t>(index)];
    const T* const net = table_->net(static_cast<std::size_t>(index));
    const std::size_t size = piece.degrees.size();
    const auto point = [&](std::size_t i) {
      i = std::min(i, size - 1);
      const Vec3d local(static_cast<double>(net[i]), static_cast<double>(net[size + i]),
                        static_cast<double>(net[2 * size + i]));
      return Vec3d(piece.origin) + local / (piece.rational ? static_cast<double>(net[3 * size + i]) : 1.0);
    };
    std::vector<HullTriangle> triangles;
    for (std::size_t i = 0; i < size; i += 3) triangles.push_back({point(i), point(i + 1), point(i + 2)});
    return triangles;
  }

  PackedPrimitivesPtr<T> pack(std::span<const int> indices) const override {
    return std::make_shared<PackedBezier<T>>(table_, first_, indices);
  }

  void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
               SurfaceBatch<T>& out) const override {
    for_each_hit(rays, hits, groups, [&](int i, const auto& mine, std::size_t index, const BezierHit<N>& at) {
      const BezierPiece<T>& piece = table_->pieces[index];
      const T* const net = table_->net(index);
      const BezierPoint<N> point = bezier_point<N, T>(piece, net, at.u, at.v);
      const Vec3<N> normal = bezier_normal<N, T>(piece, net, at.u, at.v, point);
      put_surface<T>({Vec3<N>(piece.origin) + point.position, normal, normal, N(piece.magnitude)},
                     rays.direction.at(i), i, mine, out);
    });
  }

  // u and v are the parameters of the object's patch or surface, in [0, 1].
  void parameters(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                  SurfaceBatch<T>& out) const override {
    for_each_hit(rays, hits, groups, [&](int i, const auto& mine, std::size_t index, const BezierHit<N>& at) {
      const BezierPiece<T>& piece = table_->pieces[index];
      const BezierPoint<N> point = bezier_point<N, T>(piece, table_->net(index), at.u, at.v);
      const Vec3<N> normal = out.geometric.at(i);
      const Vec3<N> along = point.du - normal * dot(normal, point.du);
      const T least = std::sqrt(std::numeric_limits<T>::epsilon()) * piece.radius;
      const Vec3<N> tangent =
          select(dot(along, along) > N(least * least), normalize(along), tangents_of(normal).first);
      const N u = N(piece.u0) + N(piece.u1 - piece.u0) * at.u,
              v = N(piece.v0) + N(piece.v1 - piece.v0) * at.v;
      put_parameters<T>({u, v, u, v, tangent}, i, mine, hits, out);
    });
  }

 private:
  template <class M>
  BezierHit<M> hit(std::size_t index, const Ray<M>& ray) const {
    return BezierRays<M>(table_->pieces[index], table_->net(index), ray).hit();
  }

  // Calls visit(register, lanes, piece, hit) for each piece that lanes of a register hit.
  template <class Visit>
  void for_each_hit(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
                    const Visit& visit) const {
    const int last = first_ + static_cast<int>(table_->pieces.size());
    for (const int i : groups) {
      const IndexLanes<T> id = load_index<T>(hits.primitive, i);
      auto rest = mask_cast<N>(id >= first_ && id < last);
      while (any(rest)) {
        const IndexOf<T> piece = id[static_cast<std::size_t>(stdx::find_first_set(rest))];
        const auto mine = rest && mask_cast<N>(id == piece);
        const auto index = static_cast<std::size_t>(piece - static_cast<IndexOf<T>>(first_));
        visit(i, mine, index, hit(index, rays.at(i)));
        rest = rest && !mine;
      }
    }
  }

  std::shared_ptr<const BezierTable<T>> table_;
  int first_;
};

}  // namespace orrery
