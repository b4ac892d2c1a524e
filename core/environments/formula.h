#pragma once

#include "core/model/environment.h"
#include "core/model/record.h"

// Environments given by a formula. Each type is one record, `template <class N> struct Gradient`, with
//   static Gradient<double> read(Params&);               in the .cpp that registers the type
//   Vec3<N> radiance(const Vec3<N>& direction) const;    for a unit direction from the scene
//   Vec3<N> most() const;                                maximum radiance per channel
//   Vec3<N> least() const;                               minimum radiance per channel
//   Vec3d constant() const;                              optional: the radiance of all directions
// `read_formula<Gradient>` is the factory of the type. Formulas are not light-sampled: their radiance varies
// so little that BSDF sampling suffices.
namespace orrery {

template <template <class> class Record, class T>
class FormulaKernel final : public LightKernel<T> {
 public:
  explicit FormulaKernel(const Record<double>& record) : record_(convert_record<Record, T, double>(record)) {}

  void sample(const SurfaceBatch<T>&, const LightChoice<T>&, const PathDraws<T>&, const LaneGroups& groups,
              LightBatch<T>& out) const override {
    for (const int i : groups) out.shadow.t_max.put(i, Lanes<T>(T(-1)));
  }
  void sample_each(const SurfaceBatch<T>&, const LightChoices<T>&, const PathDraws<T>&,
                   const LaneGroups& groups, LightBatch<T>& out) const override {
    for (const int i : groups) out.shadow.t_max.put(i, Lanes<T>(T(-1)));
  }
  void beyond(const RayBatch<T>& rays, const LightChoice<T>&, const LaneGroups& groups,
              Vec3Array<T>& radiance, Array<T>& pdf) const override {
    const auto formula = broadcast_record<Record, T>(record_);
    for (const int i : groups) {
      radiance.put(i, formula.radiance(rays.direction.at(i)));
      pdf.put(i, Lanes<T>(T(0)));
    }
  }

 private:
  const Record<T> record_;
};

template <template <class> class Record>
class FormulaEnvironment final : public Environment {
 public:
  explicit FormulaEnvironment(const Record<double>& record) : record_(record) {}
  std::optional<Vec3d> constant() const override {
    if constexpr (requires { record_.constant(); }) return record_.constant();
    return std::nullopt;
  }
  Vec3d most() const override { return record_.most(); }
  Vec3d least() const override { return record_.least(); }
  LightKernelPtr<float> kernel(float) const override {
    return std::make_unique<FormulaKernel<Record, float>>(record_);
  }
  LightKernelPtr<double> kernel(double) const override {
    return std::make_unique<FormulaKernel<Record, double>>(record_);
  }

 private:
  const Record<double> record_;
};

template <template <class> class Record>
std::shared_ptr<const Environment> read_formula(Params& p, const AssetSource&) {
  return std::make_shared<FormulaEnvironment<Record>>(Record<double>::read(p));
}

}  // namespace orrery
