#include "core/occlusion/prediction.h"

#include "core/math/compress.h"
#include "core/math/sampling.h"

namespace orrery {
namespace {

template <class T>
class Random final : public Predictor<T> {
 public:
  explicit Random(int count) : count_(static_cast<std::uint64_t>(count)) {}

  void propose(const RayBatch<T>& rays, const LaneGroups& groups,
               Array<IndexOf<T>>& primitive) const override {
    const auto bits = [](T x) { return static_cast<std::uint32_t>(std::bit_cast<IndexOf<T>>(x)); };
    for (const int i : groups) {
      const std::uint64_t drawn = combine_bits(bits(rays.origin.x[i]), bits(rays.direction.x[i]));
      primitive.put(i, IndexLanes<T>(static_cast<IndexOf<T>>(drawn * count_ >> 32)));
    }
  }

 private:
  std::uint64_t count_;
};

// Tests predicted occluders against shadow rays and counts the tests.
template <class T>
class OccluderVerifier {
 public:
  OccluderVerifier(const PrimitiveList<T>& primitives, RayBatch<T>& rays, AcceleratorCounts& counts)
      : primitives_(primitives), rays_(rays), counts_(counts) {}

  // Tests a primitive against all rays of register `i`. Ignores a number that is out of range.
  void attempt(std::int64_t primitive, int i) {
    if (primitive < 0 || primitive >= static_cast<std::int64_t>(primitives_.size())) return;
    const Primitive<T>& proposed = primitives_[static_cast<std::size_t>(primitive)];
    const LaneGroups one = LaneGroups::single(i);
    const std::uint64_t open = active_rays(rays_, one);
    proposed.kernel->occlude(proposed.index, rays_, one, counts_);
    counts_.primitive_tests += open;
    counts_.predicted_occluders += open;
    counts_.verified_occluders += open - active_rays(rays_, one);
  }

  // Tests each distinct primitive that is proposed for an active ray of register `i` against the whole
  // register.
  void attempt_each(const Array<IndexOf<T>>& primitive, int i) {
    const IndexLanes<T> proposed = load_index<T>(primitive, i);
    for (unsigned open = active(i); open != 0; open &= active(i)) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(open));
      open &= ~bits_of(proposed == IndexOf<T>(proposed[lane]));
      attempt(proposed[lane], i);
    }
  }

 private:
  unsigned active(int i) const { return bits_of(rays_.t_max.at(i) > Lanes<T>(T(0))); }

  const PrimitiveList<T>& primitives_;
  RayBatch<T>& rays_;
  AcceleratorCounts& counts_;
};

// Base class that passes closest() to the accelerator `behind_` without a prediction. Even a free and correct
// prediction of the nearest hit would save at most a tenth of the time (`script/bench prediction`).
template <class T>
class Predicted : public Accelerator<T> {
 public:
  Predicted(const PrimitiveList<T>& primitives, std::shared_ptr<const Accelerator<T>> behind)
      : primitives_(primitives), behind_(std::move(behind)) {}

  AcceleratorFacts facts() const override { return behind_->facts(); }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    behind_->closest(rays, groups, hits, counts);
  }

 protected:
  const PrimitiveList<T>& primitives_;
  std::shared_ptr<const Accelerator<T>> behind_;
};

template <class T>
class PredictorAccelerator final : public Predicted<T> {
 public:
  PredictorAccelerator(const PrimitiveList<T>& primitives, std::shared_ptr<const Accelerator<T>> behind,
                       PredictorPtr<T> predictor)
      : Predicted<T>(primitives, std::move(behind)), predictor_(std::move(predictor)) {}

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const LaneGroups active = with_active_rays(rays, groups);
    Array<IndexOf<T>> primitive;
    predictor_->propose(rays, active, primitive);
    OccluderVerifier<T> verifier(this->primitives_, rays, counts);
    for (const int i : active) verifier.attempt_each(primitive, i);
    this->behind_->occlude(rays, with_active_rays(rays, active), counts);
  }

 private:
  PredictorPtr<T> predictor_;
};

// Proposes the occluder that was found last. Accelerator::occlude() does not report occluders. One occluded
// ray of each lot is therefore traced by closest().
template <class T>
class LastOccluderCache final : public Predicted<T> {
 public:
  using Predicted<T>::Predicted;

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const LaneGroups active = with_active_rays(rays, groups);
    OccluderVerifier<T> verifier(this->primitives_, rays, counts);
    int last = kNoPrimitive;
    for (const std::uint16_t* from = active.begin(); from != active.end();) {
      LaneGroups lot;
      for (const int end = *from / kLot * kLot + kLot; from != active.end() && *from < end; ++from)
        lot.add(*from);
      for (const int i : lot) verifier.attempt(last, i);
      const LaneGroups open = with_active_rays(rays, lot);
      if (open.empty()) continue;
      const Array<T> before = rays.t_max;
      this->behind_->occlude(rays, open, counts);
      if (const int found = occluder(rays, before, open, counts); found != kNoPrimitive) last = found;
    }
  }

 private:
  static constexpr int kLot = 64;  // rays per lot; the last occluder is updated after each lot

  // Returns the occluder of the last ray that occlude() found occluded, or kNoPrimitive.
  int occluder(RayBatch<T>& rays, const Array<T>& before, const LaneGroups& groups,
               AcceleratorCounts& counts) const {
    using N = Lanes<T>;
    int ray = -1;
    for (const int i : groups) {
      const unsigned met = bits_of(before.at(i) > N(T(0)) && rays.t_max.at(i) < N(T(0)));
      if (met != 0) ray = i + std::bit_width(met) - 1;
    }
    if (ray < 0) return kNoPrimitive;
    const int i = ray / kWidth<T> * kWidth<T>;
    const N others = rays.t_max.at(i);
    rays.t_max.put(i, N(T(-1)));
    rays.t_max[ray] = before[ray];
    HitBatch<T> hits;
    hits.t.put(i, rays.t_max.at(i));
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>(kNoPrimitive)));
    this->behind_->closest(rays, LaneGroups::single(i), hits, counts);
    rays.t_max.put(i, others);
    return static_cast<int>(hits.primitive[ray]);
  }
};

}  // namespace

template <class T>
PredictorPtr<T> random_predictor(int count) {
  return std::make_shared<const Random<T>>(count);
}

template <class T>
std::shared_ptr<const Accelerator<T>> predicted(const PrimitiveList<T>& primitives,
                                                std::shared_ptr<const Accelerator<T>> behind,
                                                PredictorPtr<T> predictor) {
  return std::make_shared<const PredictorAccelerator<T>>(primitives, std::move(behind), std::move(predictor));
}

template <class T>
std::shared_ptr<const Accelerator<T>> predicted_by_last(const PrimitiveList<T>& primitives,
                                                        std::shared_ptr<const Accelerator<T>> behind) {
  return std::make_shared<const LastOccluderCache<T>>(primitives, std::move(behind));
}

#define ORRERY_FOR(T)                                                                       \
  template PredictorPtr<T> random_predictor(int);                                           \
  template std::shared_ptr<const Accelerator<T>> predicted(                                 \
      const PrimitiveList<T>&, std::shared_ptr<const Accelerator<T>>, PredictorPtr<T>);     \
  template std::shared_ptr<const Accelerator<T>> predicted_by_last(const PrimitiveList<T>&, \
                                                                   std::shared_ptr<const Accelerator<T>>);
ORRERY_FOR(float)
ORRERY_FOR(double)
#undef ORRERY_FOR

}  // namespace orrery
