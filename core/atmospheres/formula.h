#pragma once

#include "core/model/atmosphere.h"
#include "core/model/record.h"

// Atmospheres given by a formula. Each type is one record, `template <class N> struct Fog`, with
//   static Fog<double> read(Params&);     in the .cpp that registers the type
//   static constexpr const char* kName;
//   static constexpr bool kAlongAllRays;  false: camera rays only
//   static constexpr bool kHidesBackground;
//   Vec3<N> color;                        see Atmosphere
//   RoundingLimit rounding() const;       optional
//   N share(const N& distance, const N& depth) const;  of light from a point at this distance along the ray,
//   and
//                                                      at this distance along the view axis, in metres
// `read_atmosphere<Fog>` is the factory of the type.
namespace orrery {

template <template <class> class Record, class T>
class FormulaAtmosphereKernel final : public AtmosphereKernel<T> {
 public:
  explicit FormulaAtmosphereKernel(const Record<double>& record)
      : record_(convert_record<Record, T, double>(record)) {}

  void transmit(const CameraFrame& frame, const RayBatch<T>& rays, int depth, const HitBatch<T>& hits,
                const LaneGroups& groups, Array<T>& share) const override {
    const bool applies = Record<double>::kAlongAllRays || depth == 0;
    const auto formula = broadcast_record<Record, T>(record_);
    const Vec3<N> eye(Vec3<T>(frame.eye)), back(Vec3<T>(frame.back));
    for (const int i : groups) {
      N value(T(1));
      if (applies) {
        const N distance = hits.t.at(i);
        value = formula.share(distance, -dot(rays.at(i).at(distance) - eye, back));
      }
      share.put(i, value);
    }
  }

  void transmit_light(const Array<T>& distance, const LaneGroups& groups,
                      Vec3Array<T>& incident) const override {
    if (!Record<double>::kAlongAllRays) return;
    const auto formula = broadcast_record<Record, T>(record_);
    const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
    for (const int i : groups) {
      const N metres = distance.at(i);
      const auto finite = metres > zero && metres < infinity;
      incident.put(i, finite, incident.at(i) * formula.share(select(finite, metres, zero), zero));
    }
  }

 private:
  using N = Lanes<T>;

  const Record<T> record_;
};

template <template <class> class Record>
class FormulaAtmosphere final : public Atmosphere {
 public:
  explicit FormulaAtmosphere(const Record<double>& record) : record_(record) {}
  const char* type() const override { return Record<double>::kName; }
  Vec3d color() const override { return record_.color; }
  bool hides_background() const override { return Record<double>::kHidesBackground; }
  RoundingLimit rounding() const override {
    if constexpr (requires { record_.rounding(); }) return record_.rounding();
    return {};
  }
  AtmosphereKernelPtr<float> kernel(float) const override {
    return std::make_unique<FormulaAtmosphereKernel<Record, float>>(record_);
  }
  AtmosphereKernelPtr<double> kernel(double) const override {
    return std::make_unique<FormulaAtmosphereKernel<Record, double>>(record_);
  }

 private:
  const Record<double> record_;
};

template <template <class> class Record>
std::shared_ptr<const Atmosphere> read_atmosphere(Params& p) {
  return std::make_shared<FormulaAtmosphere<Record>>(Record<double>::read(p));
}

}  // namespace orrery
