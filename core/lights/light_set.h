#pragma once

#include <vector>

#include "core/lights/arrival.h"
#include "core/model/light.h"
#include "core/model/record.h"

// Light types that are represented by one point or direction. Each type is one record, `template <class N>
// struct Point`, with
//   static constexpr LightTraits kTraits;
//   static Point<double> read(Params&);                in the .cpp that registers the type
//   Vec3<N> intensity;                                 at the source; or a function whole_intensity()
//   RoundingLimit rounding() const;                    optional, of Point<double>
//   LightBounds bounds() const;                        of Point<double>
//   Vec3d max_incident(double distance) const;         of Point<double>; see LightSet
//   Arrival<N> arrive(const Vec3<N>& position) const;  light that arrives at a surface point
// and, if path tracing samples the extent of the light,
//   MaskOf<N> extended() const;                                                  whether draw() applies
//   LightSample<N> draw(const Vec3<N>& position, const N& u, const N& v) const;  for u, v in [0, 1)
//   DistantRadiance<N> beyond(const Vec3<N>& direction) const;                   if infinitely distant, with
//   Vec3d max_radiance_at_infinity() const;                                      of Point<double>
// `make_light_set<Point>` is the factory of the type.
namespace orrery {

template <template <class> class Record, class T>
class RecordLightKernel final : public LightKernel<T> {
 public:
  explicit RecordLightKernel(std::span<const Record<double>> records) {
    for (const auto& record : records) records_.push_back(convert_record<Record, T, double>(record));
  }

  void sample(const SurfaceBatch<T>& surface, const LightChoice<T>& choice, const PathDraws<T>&,
              const LaneGroups& groups, LightBatch<T>& out) const override {
    const auto light = broadcast_record<Record, T>(records_[static_cast<std::size_t>(choice.index)]);
    const Lanes<T> share(T(1) / choice.probability);
    for (const int i : groups) {
      const Arrival<Lanes<T>> arrival = light.arrive(surface.position.at(i));
      out.shadow.direction.put(i, arrival.direction);
      out.shadow.t_max.put(i, arrival.distance);
      out.incident.put(i, arrival.incident * share);
    }
  }

  void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices, const PathDraws<T>& draws,
                   const LaneGroups& groups, LightBatch<T>& out) const override {
    for (const int i : groups) {
      const IndexLanes<T> index = load_index<T>(choices.index, i);
      const auto mine = mask_cast<N>(index >= 0);
      if (!any(mine)) continue;
      const auto [arrival, pdf] =
          drawn(fetch_records<Record, T>(records_, index, mine), surface.position.at(i), draws, i);
      const N probability = choices.probability.at(i);
      out.shadow.direction.put(i, mine, arrival.direction);
      out.shadow.t_max.put(i, mine, arrival.distance);
      out.incident.put(i, mine, arrival.incident * (N(T(1)) / probability));
      out.pdf.put(i, mine, pdf * probability);
    }
  }

  void beyond(const RayBatch<T>& rays, const LightChoice<T>& choice, const LaneGroups& groups,
              Vec3Array<T>& radiance, Array<T>& pdf) const override {
    const auto light = broadcast_record<Record, T>(records_[static_cast<std::size_t>(choice.index)]);
    if constexpr (!requires(Vec3<N> direction) { light.beyond(direction); })
      return LightKernel<T>::beyond(rays, choice, groups, radiance, pdf);
    else
      for (const int i : groups) {
        const DistantRadiance<N> seen = light.beyond(rays.direction.at(i));
        radiance.put(i, seen.radiance);
        pdf.put(i, seen.pdf * choice.probability);
      }
  }

 private:
  using N = Lanes<T>;

  static LightSample<N> drawn(const Record<N>& light, const Vec3<N>& position, const PathDraws<T>& draws,
                              int i) {
    const N zero(T(0));
    if constexpr (requires { light.extended(); }) {
      const auto extended = light.extended();
      if (any(extended)) {
        const auto [u, v] = draws.two(SampleSet::light, i);
        const auto [area, pdf] = light.draw(position, u, v);
        if (all(extended)) return {area, pdf};
        const Arrival<N> point = light.arrive(position);
        return {{select(extended, area.direction, point.direction),
                 select(extended, area.distance, point.distance),
                 select(extended, area.incident, point.incident)},
                select(extended, pdf, zero)};
      }
    }
    return {light.arrive(position), zero};
  }

  std::vector<Record<T>> records_;
};

template <template <class> class Record>
class RecordLightSet final : public LightSet {
 public:
  void add(Params& params) override { records_.push_back(Record<double>::read(params)); }
  int size() const override { return static_cast<int>(records_.size()); }
  LightTraits traits() const override { return Record<double>::kTraits; }
  Vec3d intensity(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.whole_intensity(); })
      return record.whole_intensity();
    else
      return record.intensity;
  }
  LightBounds bounds(int index) const override { return records_[static_cast<std::size_t>(index)].bounds(); }
  Vec3d max_incident(int index, double distance) const override {
    return records_[static_cast<std::size_t>(index)].max_incident(distance);
  }
  Vec3d max_radiance_at_infinity(int index) const override {
    if constexpr (requires(const Record<double>& record) { record.max_radiance_at_infinity(); })
      return records_[static_cast<std::size_t>(index)].max_radiance_at_infinity();
    return Vec3d(0);
  }
  RoundingLimit rounding(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.rounding(); })
      return record.rounding();
    else
      return {};
  }
  bool extended(int index) const override {
    if constexpr (requires(const Record<double>& record) { record.extended(); })
      return records_[static_cast<std::size_t>(index)].extended();
    return false;
  }
  LightKernelPtr<float> kernel(float) const override { return make<float>(); }
  LightKernelPtr<double> kernel(double) const override { return make<double>(); }

 private:
  template <class T>
  LightKernelPtr<T> make() const {
    return std::make_unique<RecordLightKernel<Record, T>>(std::span<const Record<double>>(records_));
  }
  std::vector<Record<double>> records_;
};

template <template <class> class Record>
std::unique_ptr<LightSet> make_light_set() {
  return std::make_unique<RecordLightSet<Record>>();
}

}  // namespace orrery
