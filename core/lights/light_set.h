#pragma once

#include <vector>

#include "core/lights/arrival.h"
#include "core/model/light.h"
#include "core/model/record.h"

// A light type without extent is one record, `template <class N> struct Point`, with
//   static constexpr LightTraits kTraits;
//   static Point<double> read(Params&);                in the .cpp, which registers the type
//   Vec3<N> intensity;                                 at the source
//   RoundingLimit rounding() const;                    of a Point<double>, if it has one
//   Arrival<N> arrive(const Vec3<N>& position) const;  what arrives at a surface point
// and `make_light_set<Point>` is its factory.
namespace orrery {

template <template <class> class Record, class T>
class DeltaLightKernel final : public LightKernel<T> {
 public:
  explicit DeltaLightKernel(std::span<const Record<double>> records) {
    for (const auto& record : records) records_.push_back(convert_record<Record, T, double>(record));
  }

  void sample(const SurfaceBatch<T>& surface, const LightChoice<T>& choice, const PathDraws<T>&,
              const Groups& groups, LightBatch<T>& out) const override {
    const auto light = broadcast_record<Record, T>(records_[static_cast<std::size_t>(choice.index)]);
    const Lanes<T> share(T(1) / choice.probability);
    for (const int i : groups) {
      const Arrival<Lanes<T>> arrival = light.arrive(surface.position.at(i));
      out.shadow.direction.put(i, arrival.direction);
      out.shadow.t_max.put(i, arrival.distance);
      out.incident.put(i, arrival.incident * share);
    }
  }

  void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices, const PathDraws<T>&,
                   const Groups& groups, LightBatch<T>& out) const override {
    using N = Lanes<T>;
    for (const int i : groups) {
      const IndexLanes<T> index = load_index<T>(choices.index, i);
      const auto mine = mask_cast<N>(index >= 0);
      if (!any(mine)) continue;
      const Arrival<N> arrival =
          fetch_records<Record, T>(records_, index, mine).arrive(surface.position.at(i));
      out.shadow.direction.put(i, mine, arrival.direction);
      out.shadow.t_max.put(i, mine, arrival.distance);
      out.incident.put(i, mine, arrival.incident * (N(T(1)) / choices.probability.at(i)));
      out.pdf.put(i, mine, N(T(0)));
    }
  }

 private:
  std::vector<Record<T>> records_;
};

template <template <class> class Record>
class DeltaLightSet final : public LightSet {
 public:
  void add(Params& params) override { records_.push_back(Record<double>::read(params)); }
  int size() const override { return static_cast<int>(records_.size()); }
  LightTraits traits() const override { return Record<double>::kTraits; }
  Vec3d intensity(int index) const override { return records_[static_cast<std::size_t>(index)].intensity; }
  RoundingLimit rounding(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.rounding(); })
      return record.rounding();
    else
      return {};
  }
  LightKernelPtr<float> kernel(float) const override { return make<float>(); }
  LightKernelPtr<double> kernel(double) const override { return make<double>(); }

 private:
  template <class T>
  LightKernelPtr<T> make() const {
    return std::make_unique<DeltaLightKernel<Record, T>>(std::span<const Record<double>>(records_));
  }
  std::vector<Record<double>> records_;
};

template <template <class> class Record>
std::unique_ptr<LightSet> make_light_set() {
  return std::make_unique<DeltaLightSet<Record>>();
}

}  // namespace orrery
