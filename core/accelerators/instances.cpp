#include "core/accelerators/instances.h"

namespace orrery {
namespace {

// Packed instances. Consecutive rays or packets that are tested against the same block are gathered into one
// batch per instance.
template <class T>
class PackedInstances final : public PackedPrimitives<T> {
 public:
  using RayBlockPairs = typename PackedPrimitives<T>::RayBlockPairs;

  PackedInstances(std::shared_ptr<const PlacedList<T>> placed, std::span<const int> indices)
      : placed_(std::move(placed)), indices_(indices.begin(), indices.end()) {}

  void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch, [&](const PlacedInstance<T>& placed, RayBlockPairs some) {
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
    each_instance(pairs, kBatch, [&](const PlacedInstance<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, rays, hits);
      counts.primitive_tests += active_rays(visit->rays, visit_groups(some));
      placed.model->accelerator->occlude(visit->rays, visit_groups(some), counts);
      for (std::size_t k = 0; k < some.size(); ++k)
        if (visit->rays.t_max[static_cast<int>(k)] < 0) hits[some[k].ray].t = T(-1);
    });
  }

  void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch / kWidth<T>, [&](const PlacedInstance<T>& placed, RayBlockPairs some) {
      const auto visit = gather(placed, some, packets, hits);
      counts.primitive_tests += active_rays(visit->rays, packet_groups(some));
      placed.model->accelerator->closest(visit->rays, packet_groups(some), visit->hits, counts);
      for (std::size_t k = 0; k < some.size(); ++k) {
        const int i = static_cast<int>(k) * kWidth<T>;
        PacketHit<T>& hit = hits[some[k].ray];
        const TakenHits<T> taken(placed.first, *visit, i, hit.t, hit.primitive);
        stdx::where(taken.nearer, hit.t) = taken.t;
        stdx::where(mask_cast<IndexLanes<T>>(taken.nearer), hit.primitive) = taken.id;
        hit.farthest = stdx::hmax(hit.t);
      }
    });
  }

  void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
               AcceleratorCounts& counts) const override {
    each_instance(pairs, kBatch / kWidth<T>, [&](const PlacedInstance<T>& placed, RayBlockPairs some) {
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

  // Calls act(instance, pairs) for each instance of each block, with up to `most` consecutive pairs of that
  // block.
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

  static LaneGroups visit_groups(RayBlockPairs some) {
    return LaneGroups::covering(0, static_cast<int>(some.size()), kWidth<T>);
  }
  static LaneGroups packet_groups(RayBlockPairs some) {
    return LaneGroups::covering(0, static_cast<int>(some.size()) * kWidth<T>, kWidth<T>);
  }

  static std::unique_ptr<ModelVisit<T>> gather(const PlacedInstance<T>& placed, RayBlockPairs some,
                                               const SingleRay<T>* rays, const SingleHit<T>* hits) {
    std::unique_ptr<ModelVisit<T>> visit(new ModelVisit<T>);
    RayBatch<T>& batch = visit->rays;
    batch.count = static_cast<int>(some.size());
    const int room = (batch.count + kWidth<T> - 1) / kWidth<T> * kWidth<T>;
    for (int i = 0; i < room; ++i) {
      const RayBlockPair& pair = some[std::min(static_cast<std::size_t>(i), some.size() - 1)];
      batch.set(i, rays[pair.ray].ray, i < batch.count ? hits[pair.ray].t : T(-1));
    }
    for (int i = 0; i < room; i += kWidth<T>)
      visit->put(i, placed.pose().to_model(batch.at(i)), batch.t_max.at(i));
    return visit;
  }

  static std::unique_ptr<ModelVisit<T>> gather(const PlacedInstance<T>& placed, RayBlockPairs some,
                                               const Packet<T>* packets, const PacketHit<T>* hits) {
    std::unique_ptr<ModelVisit<T>> visit(new ModelVisit<T>);
    visit->rays.count = static_cast<int>(some.size()) * kWidth<T>;
    for (std::size_t k = 0; k < some.size(); ++k)
      visit->put(static_cast<int>(k) * kWidth<T>, placed.pose().to_model(packets[some[k].ray].ray),
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
PackedPrimitivesPtr<T> InstanceKernel<T>::pack(std::span<const int> indices) const {
  return std::make_unique<PackedInstances<T>>(this->placed_, indices);
}

template class InstanceKernel<float>;
template class InstanceKernel<double>;

}  // namespace orrery
