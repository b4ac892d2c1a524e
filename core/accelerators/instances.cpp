#include "core/accelerators/instances.h"

#include <algorithm>

namespace orrery {
namespace {

template <class T>
using N = Lanes<T>;

// Rays on their way through one model, and what they meet there.
template <class T>
struct Visit {
  RayBatch<T> rays;
  HitBatch<T> hits;

  void put(int i, const Ray<N<T>>& ray, const N<T>& t) {
    rays.origin.put(i, ray.origin);
    rays.direction.put(i, ray.direction);
    rays.t_max.put(i, t);
    hits.t.put(i, t);
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
};

// Lanes whose hit in the model, at register i, takes the place of (best, best_id), and its number in the
// scene.
template <class T>
struct Taken {
  MaskOf<N<T>> nearer;
  N<T> t;
  IndexLanes<T> id;

  Taken(const Placed<T>& placed, const Visit<T>& visit, int i, const N<T>& best, const IndexLanes<T>& best_id)
      : t(visit.hits.t.at(i)) {
    const IndexLanes<T> in_model = load_index<T>(visit.hits.primitive, i);
    id = in_model + IndexOf<T>(placed.first);
    const auto met = mask_cast<N<T>>(in_model != IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
    nearer = met && takes_over(t, id, best, best_id);
  }
};

// Instances in blocks. Single rays are put together to batches first: all that meet one instance.
template <class T>
class PackedInstances final : public PackedPrimitives<T> {
 public:
  using RayBlockPairs = typename PackedPrimitives<T>::RayBlockPairs;

  PackedInstances(std::shared_ptr<const PlacedList<T>> placed, std::span<const int> indices)
      : placed_(std::move(placed)), indices_(indices.begin(), indices.end()) {}

  void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch, [&](const Placed<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, rays, hits);
      counts.primitive_tests += active_rays(visit->rays, visit_groups(some));
      placed.model->accelerator->closest(visit->rays, visit_groups(some), visit->hits, counts);
      for (std::size_t k = 0; k < some.size(); ++k) {
        const int i = static_cast<int>(k);
        if (visit->hits.primitive[i] == kNoPrimitive) continue;
        const auto id = static_cast<IndexOf<T>>(visit->hits.primitive[i] + placed.first);
        SingleHit<T>& hit = hits[some[k].ray];
        const bool lower = id < hit.primitive || hit.primitive == kNoPrimitive;
        if (visit->hits.t[i] < hit.t || (visit->hits.t[i] == hit.t && lower)) hit = {visit->hits.t[i], id};
      }
    });
  }

  void occlude(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch, [&](const Placed<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, rays, hits);
      counts.primitive_tests += active_rays(visit->rays, visit_groups(some));
      placed.model->accelerator->occlude(visit->rays, visit_groups(some), counts);
      for (std::size_t k = 0; k < some.size(); ++k)
        if (visit->rays.t_max[static_cast<int>(k)] < 0) hits[some[k].ray].t = T(-1);
    });
  }

  void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch / kWidth<T>, [&](const Placed<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, packets, hits);
      counts.primitive_tests += active_rays(visit->rays, packet_groups(some));
      placed.model->accelerator->closest(visit->rays, packet_groups(some), visit->hits, counts);
      for (std::size_t k = 0; k < some.size(); ++k) {
        const int i = static_cast<int>(k) * kWidth<T>;
        PacketHit<T>& hit = hits[some[k].ray];
        const Taken<T> taken(placed, *visit, i, hit.t, hit.primitive);
        stdx::where(taken.nearer, hit.t) = taken.t;
        stdx::where(mask_cast<IndexLanes<T>>(taken.nearer), hit.primitive) = taken.id;
        hit.farthest = stdx::hmax(hit.t);
      }
    });
  }

  void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch / kWidth<T>, [&](const Placed<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, packets, hits);
      counts.primitive_tests += active_rays(visit->rays, packet_groups(some));
      placed.model->accelerator->occlude(visit->rays, packet_groups(some), counts);
      for (std::size_t k = 0; k < some.size(); ++k) {
        PacketHit<T>& hit = hits[some[k].ray];
        hit.t = visit->rays.t_max.at(static_cast<int>(k) * kWidth<T>);
        hit.farthest = stdx::hmax(hit.t);
      }
    });
  }

  std::size_t bytes() const override { return indices_.size() * sizeof(int); }
  std::vector<int> indices() const override { return indices_; }

 private:
  static constexpr std::size_t kSize = static_cast<std::size_t>(kBlock<T>);

  // Calls act(instance, pairs) with up to `most` pairs of one block, for each instance in it.
  template <class Act>
  void each_instance(RayBlockPairs pairs, int most, const Act& act) const {
    while (!pairs.empty()) {
      const std::uint32_t block = pairs.front().block;
      std::size_t count = 1;
      while (count < std::min(pairs.size(), static_cast<std::size_t>(most)) && pairs[count].block == block)
        ++count;
      for (std::size_t place = 0; place < kSize; ++place)
        if (const int index = indices_[block * kSize + place]; index != kNothing)
          act((*placed_)[static_cast<std::size_t>(index)], pairs.first(count));
      pairs = pairs.subspan(count);
    }
  }

  static Groups visit_groups(RayBlockPairs some) {
    return Groups::covering(0, static_cast<int>(some.size()), kWidth<T>);
  }
  static Groups packet_groups(RayBlockPairs some) {
    return Groups::covering(0, static_cast<int>(some.size()) * kWidth<T>, kWidth<T>);
  }

  static std::unique_ptr<Visit<T>> gather(const Placed<T>& placed, RayBlockPairs some,
                                          const SingleRay<T>* rays, const SingleHit<T>* hits) {
    std::unique_ptr<Visit<T>> visit(new Visit<T>);
    RayBatch<T>& batch = visit->rays;
    batch.count = static_cast<int>(some.size());
    const int room = (batch.count + kWidth<T> - 1) / kWidth<T> * kWidth<T>;
    for (int i = 0; i < room; ++i) {
      const RayBlockPair& pair = some[std::min(static_cast<std::size_t>(i), some.size() - 1)];
      batch.set(i, rays[pair.ray].ray, i < batch.count ? hits[pair.ray].t : T(-1));
    }
    for (int i = 0; i < room; i += kWidth<T>) visit->put(i, placed.to_model(batch.at(i)), batch.t_max.at(i));
    return visit;
  }

  static std::unique_ptr<Visit<T>> gather(const Placed<T>& placed, RayBlockPairs some,
                                          const Packet<T>* packets, const PacketHit<T>* hits) {
    std::unique_ptr<Visit<T>> visit(new Visit<T>);
    visit->rays.count = static_cast<int>(some.size()) * kWidth<T>;
    for (std::size_t k = 0; k < some.size(); ++k)
      visit->put(static_cast<int>(k) * kWidth<T>, placed.to_model(packets[some[k].ray].ray),
                 hits[some[k].ray].t);
    return visit;
  }

  std::shared_ptr<const PlacedList<T>> placed_;
  std::vector<int> indices_;
};

}  // namespace

Boundsd box_around(const Boundsd& model, const Affined& world_from_model) {
  Boundsd box;
  for (const Vec3d& corner : corners_of(model)) box.include(world_from_model.point(corner));
  return box;
}

Boundsd bounds_of(const Boundsd& model, const Affined& world_from_model) {
  if (!model.bounded()) return Boundsd::everything();
  Boundsd box = box_around(model, world_from_model);
  const double condition = stretch(world_from_model) * stretch(inverse(world_from_model));
  const double pad = 16 * double{std::numeric_limits<float>::epsilon()} * condition * box.magnitude();
  box.lo = box.lo - Vec3d(pad);
  box.hi = box.hi + Vec3d(pad);
  return box;
}

template <class T>
void InstanceKernel<T>::closest(int index, const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                                AcceleratorCounts& counts) const {
  const Placed<T>& placed = (*placed_)[static_cast<std::size_t>(index)];
  const std::unique_ptr<Visit<T>> visit(new Visit<T>);
  visit->rays.count = rays.count;
  for (const int i : groups) visit->put(i, placed.to_model(rays.at(i)), hits.t.at(i));
  placed.model->accelerator->closest(visit->rays, groups, visit->hits, counts);
  for (const int i : groups) {
    const Taken<T> taken(placed, *visit, i, hits.t.at(i), load_index<T>(hits.primitive, i));
    hits.t.put(i, taken.nearer, taken.t);
    hits.primitive.put(i, mask_cast<IndexLanes<T>>(taken.nearer), taken.id);
  }
}

template <class T>
void InstanceKernel<T>::occlude(int index, RayBatch<T>& rays, const Groups& groups,
                                AcceleratorCounts& counts) const {
  const Placed<T>& placed = (*placed_)[static_cast<std::size_t>(index)];
  const std::unique_ptr<Visit<T>> visit(new Visit<T>);
  visit->rays.count = rays.count;
  for (const int i : groups) visit->put(i, placed.to_model(rays.at(i)), rays.t_max.at(i));
  placed.model->accelerator->occlude(visit->rays, groups, counts);
  for (const int i : groups) rays.t_max.put(i, visit->rays.t_max.at(i));
}

template <class T>
PackedPrimitivesPtr<T> InstanceKernel<T>::pack(std::span<const int> indices) const {
  return std::make_unique<PackedInstances<T>>(placed_, indices);
}

// A register may hold hits of several instances: each takes its own lanes.
template <class T>
template <class Visit>
void InstanceKernel<T>::for_each_hit(const HitBatch<T>& hits, const Groups& groups,
                                     const Visit& visit) const {
  const auto owner = [this](IndexOf<T> id) {
    return std::upper_bound(placed_->begin(), placed_->end(), id,
                            [](IndexOf<T> number, const Placed<T>& p) { return number < p.last; });
  };
  for (const int i : groups) {
    const IndexLanes<T> id = load_index<T>(hits.primitive, i);
    auto open = id >= IndexOf<T>(placed_->front().first) && id < IndexOf<T>(placed_->back().last);
    while (any(open)) {
      const Placed<T>& placed = *owner(id[static_cast<std::size_t>(stdx::find_first_set(open))]);
      const auto here = open && id >= IndexOf<T>(placed.first) && id < IndexOf<T>(placed.last);
      open = open && !here;
      IndexLanes<T> in_model(IndexOf<T>{kNoPrimitive});
      stdx::where(here, in_model) = id - IndexOf<T>(placed.first);
      visit(i, mask_cast<N<T>>(here), placed, in_model);
    }
  }
}

template <class T>
void InstanceKernel<T>::surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const Groups& groups,
                                SurfaceBatch<T>& out) const {
  const std::unique_ptr<Visit<T>> visit(new Visit<T>);
  const std::unique_ptr<SurfaceBatch<T>> found(new SurfaceBatch<T>);
  visit->rays.count = rays.count;
  for_each_hit(hits, groups, [&](int i, const auto& mask, const Placed<T>& placed, const auto& in_model) {
    visit->put(i, placed.to_model(rays.at(i)), hits.t.at(i));
    visit->hits.primitive.put(i, in_model);
    for (const auto& shapes : placed.model->shapes)
      shapes->surface(visit->rays, visit->hits, Groups::single(i), *found);
    const auto to_world = placed.world_from_model.template as<N<T>>();
    const auto from_world = placed.model_from_world.template as<N<T>>();
    out.position.put(i, mask, to_world.point(found->position.at(i)));
    out.geometric.put(i, mask, normalize(from_world.transposed(found->geometric.at(i))));
    out.normal.put(i, mask, normalize(from_world.transposed(found->normal.at(i))));
    out.side.put(i, mask, found->side.at(i));
    out.step.put(i, mask, N<T>(found->step.at(i) * N<T>(placed.step_scale) + N<T>(placed.step_base)));
  });
}

template <class T>
void InstanceKernel<T>::parameters(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                                   SurfaceBatch<T>& out) const {
  const std::unique_ptr<Visit<T>> visit(new Visit<T>);
  const std::unique_ptr<SurfaceBatch<T>> found(new SurfaceBatch<T>);
  visit->rays.count = rays.count;
  for_each_hit(hits, groups, [&](int i, const auto& mask, const Placed<T>& placed, const auto& in_model) {
    visit->put(i, placed.to_model(rays.at(i)), hits.t.at(i));
    visit->hits.primitive.put(i, in_model);
    for (const auto& shapes : placed.model->shapes) {
      shapes->surface(visit->rays, visit->hits, Groups::single(i), *found);
      shapes->parameters(visit->rays, Groups::single(i), visit->hits, *found);
    }
    hits.u.put(i, mask, visit->hits.u.at(i));
    hits.v.put(i, mask, visit->hits.v.at(i));
    out.u.put(i, mask, found->u.at(i));
    out.v.put(i, mask, found->v.at(i));
    const auto to_world = placed.world_from_model.template as<N<T>>();
    out.tangent.put(i, mask, normalize(to_world.vector(found->tangent.at(i))));
  });
}

template class InstanceKernel<float>;
template class InstanceKernel<double>;

}  // namespace orrery
