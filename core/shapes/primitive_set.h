#pragma once

#include <vector>

#include "core/base/task_scope.h"
#include "core/shapes/packed_records.h"

// A shape type is one record, `template <class N> struct Sphere`, with
//   static constexpr ShapeTraits kTraits;
//   static void read(Params&, std::vector<Sphere<double>>& out);   appends the primitives of one object;
//                                                 in the .cpp, which registers the type
//   Boundsd bounds() const;                                        of a Sphere<double>
//   N distance(const Ray<N>&) const;              the smallest t > 0 of a hit; +infinity or NaN for a miss
//   Surface<N> surface(const Ray<N>&, const N& t) const;
//   SmoothSurface<N> smooth(const Ray<N>&) const;   if it has vertex normals: see ShapeKernel::smooth()
//   SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const;   of a position on the shape
//   void tessellate(const TessellationView&, int primitive, Tessellation&) const;   of a Sphere<double>,
//                                                 in the .cpp
//   Vec3d anchor() const;                         if it may be unbounded: see ShapeSet::anchor_magnitude()
//   double min_distance(const Vec3d&) const;      if it may be unbounded: see ShapeSet
//   OccupiedSpace::Plane plane() const;           if it is part of a plane: see ShapeSet
//   std::vector<HullTriangle> hull() const;       if tighter than bounds(): see ShapeKernel
//   Patch patch() const;                          of a Sphere<double>, if light can be sampled from it;
//                                                 std::optional<Patch> if that depends on the shape
//   Core, core()                                  if distance() needs only part of it: see packed_records.h
// and `make_shape_set<Sphere>` as its factory. Formulas are evaluated for scalars and for lanes.
namespace orrery {

// List of records, converted to the render's precision.
template <template <class> class Record, class T>
class PlainRecords {
 public:
  explicit PlainRecords(std::span<const Record<double>> records) {
    records_.reserve(records.size());
    for (const auto& record : records) records_.push_back(convert_record<Record, T, double>(record));
  }
  std::size_t size() const { return records_.size(); }
  const Record<T>& operator[](std::size_t i) const { return records_[i]; }
  decltype(auto) core(std::size_t i) const { return CoreOf<Record, T>::of(records_[i]); }

  // Record type whose parameters() maps positions to parameters.
  template <class N>
  using Mapping = Record<N>;
  const PlainRecords& mappings() const { return *this; }

 private:
  std::vector<Record<T>> records_;
};

// Writes `s` to the lanes `mine` of register i. Turns normals against `direction`, the direction of the rays.
template <class T>
[[gnu::always_inline]] inline void put_surface(const Surface<Lanes<T>>& s, const Vec3<Lanes<T>>& direction,
                                               int i, const MaskOf<Lanes<T>>& mine, SurfaceBatch<T>& out) {
  using N = Lanes<T>;
  const N side = select(dot(s.geometric, direction) > N(0), N(-1), N(1));
  out.position.put(i, mine, s.position);
  out.geometric.put(i, mine, s.geometric * side);
  out.normal.put(i, mine, s.normal * side);
  out.side.put(i, mine, side);
  out.step.put(i, mine, s.magnitude * (8 * std::numeric_limits<T>::epsilon()));
}
template <class T>
[[gnu::always_inline]] inline void put_parameters(const SurfacePoint<Lanes<T>>& point, int i,
                                                  const MaskOf<Lanes<T>>& mine, HitBatch<T>& hits,
                                                  SurfaceBatch<T>& out) {
  hits.u.put(i, mine, point.u);
  hits.v.put(i, mine, point.v);
  out.u.put(i, mine, point.s);
  out.v.put(i, mine, point.t);
  out.tangent.put(i, mine, point.tangent);
}

template <class T>
[[gnu::always_inline]] inline void put_smooth(const SmoothSurface<Lanes<T>>& s, int i,
                                              const MaskOf<Lanes<T>>& mine, SurfaceBatch<T>& out) {
  out.smooth.put(i, mine, s.normal);
  out.lift.put(i, mine, s.lift);
}

// Kernel of one shape type. `Records` is PlainRecords or a class with the same members.
template <template <class> class Record, class T, class Records = PlainRecords<Record, T>>
class PrimitiveKernel final : public ShapeKernel<T> {
 public:
  using N = Lanes<T>;

  PrimitiveKernel(Records records, int first) : records_(std::move(records)), first_(first) {}

  [[gnu::flatten]] void closest(int index, const RayBatch<T>& rays, const LaneGroups& groups,
                                HitBatch<T>& hits, AcceleratorCounts&) const override {
    const auto shape = broadcast_record<Record, T>(records_[static_cast<std::size_t>(index)]);
    const IndexLanes<T> id(static_cast<IndexOf<T>>(first_ + index));
    for (const int i : groups) {
      const N best = hits.t.at(i);
      const N t = shape.distance(rays.at(i));
      if (!any(t <= min_first(best, N(std::numeric_limits<T>::max())))) continue;
      const auto nearer = is_nearer_hit(t, id, best, load_index<T>(hits.primitive, i));
      hits.t.put(i, nearer, t);
      hits.primitive.put(i, mask_cast<IndexLanes<T>>(nearer), id);
    }
  }

  [[gnu::flatten]] void occlude(int index, RayBatch<T>& rays, const LaneGroups& groups,
                                AcceleratorCounts&) const override {
    const auto shape = broadcast_record<Record, T>(records_[static_cast<std::size_t>(index)]);
    for (const int i : groups) {
      const auto hit = shape.distance(rays.at(i)) < rays.t_max.at(i);
      if (any(hit)) rays.t_max.put(i, hit, N(-1));
    }
  }

  std::vector<HullTriangle> hull(int index) const override {
    if constexpr (requires { records_[0].hull(); })
      return records_[static_cast<std::size_t>(index)].hull();
    else
      return {};
  }

  PackedPrimitivesPtr<T> pack(std::span<const int> indices) const override {
    return std::make_unique<PackedRecords<Record, T>>(records_, first_, indices);
  }

  [[gnu::flatten]] void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
                                SurfaceBatch<T>& out) const override {
    for_each_hit(hits, groups, [&](int i, const auto& mine, const IndexLanes<T>& index) {
      const auto shape = fetch_records<Record, T>(records_, index, mine);
      put_surface<T>(shape.surface(rays.at(i), hits.t.at(i)), rays.direction.at(i), i, mine, out);
    });
  }

  void parameters(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                  SurfaceBatch<T>& out) const override {
    for_each_hit(hits, groups, [&](int i, const auto& mine, const IndexLanes<T>& index) {
      const auto mapping = fetch_records<Records::template Mapping, T>(records_.mappings(), index, mine);
      put_parameters<T>(mapping.parameters(rays.at(i), out.position.at(i)), i, mine, hits, out);
    });
  }

  void smooth(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
              SurfaceBatch<T>& out) const override {
    if constexpr (requires(const Record<N>& shape) { shape.smooth(rays.at(0)); })
      for_each_hit(hits, groups, [&](int i, const auto& mine, const IndexLanes<T>& index) {
        const auto shape = fetch_records<Record, T>(records_, index, mine);
        put_smooth<T>(shape.smooth(rays.at(i)), i, mine, out);
      });
  }

  void colors(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
              SurfaceBatch<T>& out) const override {
    if constexpr (requires { records_.colors(); }) {
      if (!records_.has_colors()) return;
      for_each_hit(hits, groups, [&](int i, const auto& mine, const IndexLanes<T>& index) {
        const auto record = fetch_records<Records::template Colors, T>(records_.colors(), index, mine);
        out.color.put(i, mine, record.color(rays.at(i)));
      });
    }
  }

 private:
  // Calls visit(register, lanes, index of their records) for each register of `groups` with hits on the set.
  template <class Visit>
  [[gnu::always_inline]] void for_each_hit(const HitBatch<T>& hits, const LaneGroups& groups,
                                           const Visit& visit) const {
    const int last = first_ + static_cast<int>(records_.size());
    for (const int i : groups) {
      const IndexLanes<T> id = load_index<T>(hits.primitive, i);
      const auto mine = mask_cast<N>(id >= first_ && id < last);
      if (any(mine)) visit(i, mine, IndexLanes<T>(id - first_));
    }
  }

  Records records_;
  int first_;
};

template <template <class> class Record>
class PrimitiveSet final : public ShapeSet {
 public:
  int add(Params& params, MeshSource&) override {
    const std::size_t before = records_.size();
    Record<double>::read(params, records_);
    return static_cast<int>(records_.size() - before);
  }
  int size() const override { return static_cast<int>(records_.size()); }
  Boundsd bounds(int index) const override { return records_[static_cast<std::size_t>(index)].bounds(); }
  double anchor_magnitude(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.anchor(); })
      return record.bounds().bounded() ? 0 : max_component(abs(record.anchor()));
    else
      return 0;
  }
  double min_distance(int index, const Vec3d& point) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.min_distance(point); })
      return record.min_distance(point);
    else
      return 0;
  }
  std::optional<OccupiedSpace::Plane> plane(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.plane(); })
      return record.plane();
    else
      return std::nullopt;
  }
  ShapeTraits traits() const override { return Record<double>::kTraits; }
  std::optional<Patch> patch(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.patch(); })
      return record.patch();
    else
      return std::nullopt;
  }
  void tessellate(const TessellationView& view, int first, Tessellation& out) const override {
    for (std::size_t i = 0; i < records_.size(); ++i) {
      checkpoint(i);
      records_[i].tessellate(view, first + static_cast<int>(i), out);
    }
  }
  ShapeKernelPtr<float> kernel(float, int first) const override { return make<float>(first); }
  ShapeKernelPtr<double> kernel(double, int first) const override { return make<double>(first); }
  ShapeKernelPtr<long double> kernel(long double, int first) const override {
    return make<long double>(first);
  }

 private:
  template <class T>
  ShapeKernelPtr<T> make(int first) const {
    return std::make_unique<PrimitiveKernel<Record, T>>(PlainRecords<Record, T>(records_), first);
  }
  std::vector<Record<double>> records_;
};

template <template <class> class Record>
std::unique_ptr<ShapeSet> make_shape_set() {
  return std::make_unique<PrimitiveSet<Record>>();
}

}  // namespace orrery
