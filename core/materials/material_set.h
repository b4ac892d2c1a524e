#pragma once

#include <vector>

#include "core/model/material.h"
#include "core/model/record.h"

// A material type is one record, `template <class N> struct Rough`, and one kernel class `Kernel<T>` that
// derives from MaterialRecords<Rough, T>. The record contains the formulas and the following functions, which
// are called for Rough<double> only. The last five are optional: see MaterialSet for their meaning and
// defaults.
//   static Rough<double> read(Params&);  defined in the .cpp file, which registers the type
//   MaterialTraits traits() const;
//   RoundingLimit rounding() const;
//   double mirrored_share() const;       if the material mirrors
//   double max_albedo() const;           if the material may create energy
//   ReflectionLimits limits() const;     if bounds are known
//   Medium medium() const;               if closed surfaces enclose a medium
namespace orrery {

// Materials of one type in the render's precision, and a loop over the registers that contain surfaces with
// these materials.
template <template <class> class Record, class T>
class MaterialRecords : public MaterialKernel<T> {
 public:
  using N = Lanes<T>;

  MaterialRecords(std::span<const Record<double>> records, int first) : first_(first) {
    for (const auto& record : records) records_.push_back(convert_record<Record, T, double>(record));
  }

 protected:
  // Calls visit(i, mine, record) for each register of `groups` with at least one of these materials. i is the
  // first ray of the register. `mine` are the lanes with these materials, and `record` contains the material
  // of each such lane.
  template <class Visit>
  void for_each_register(const SurfaceBatch<T>& surface, const LaneGroups& groups, const Visit& visit) const {
    const int last = first_ + static_cast<int>(records_.size());
    for (const int i : groups) {
      const IndexLanes<T> material = load_index<T>(surface.material, i);
      const auto mine = mask_cast<N>(material >= first_ && material < last);
      if (any(mine)) visit(i, mine, fetch_records<Record, T>(records_, material - first_, mine));
    }
  }

 private:
  std::vector<Record<T>> records_;
  int first_;
};

template <template <class> class Record, template <class> class Kernel>
class MaterialSetOf final : public MaterialSet {
 public:
  void add(Params& params) override { records_.push_back(Record<double>::read(params)); }
  int size() const override { return static_cast<int>(records_.size()); }
  MaterialTraits traits() const override {
    MaterialTraits all;
    for (const auto& record : records_) all |= record.traits();
    return all;
  }
  RoundingLimit rounding(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.rounding(); })
      return record.rounding();
    else
      return {};
  }
  double mirrored_share(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.mirrored_share(); })
      return record.mirrored_share();
    else
      return 0;
  }
  double max_albedo(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.max_albedo(); })
      return record.max_albedo();
    else
      return 1;
  }
  ReflectionLimits limits(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.limits(); })
      return record.limits();
    else
      return {};
  }
  std::optional<Medium> medium(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.medium(); })
      return record.medium();
    else
      return std::nullopt;
  }
  MaterialKernelPtr<float> kernel(float, int first) const override {
    return std::make_unique<Kernel<float>>(std::span<const Record<double>>(records_), first);
  }
  MaterialKernelPtr<double> kernel(double, int first) const override {
    return std::make_unique<Kernel<double>>(std::span<const Record<double>>(records_), first);
  }

 private:
  std::vector<Record<double>> records_;
};

template <template <class> class Record, template <class> class Kernel>
std::unique_ptr<MaterialSet> make_material_set() {
  return std::make_unique<MaterialSetOf<Record, Kernel>>();
}

}  // namespace orrery
