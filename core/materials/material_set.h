#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/materials/material_params.h"
#include "core/materials/textured_inputs.h"
#include "core/model/material.h"

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
//
// If parameters of the type may be textured, the record has, instead of read(),
//   template <class M> using Inputs = RoughInputs<M>;
// which is a record with the parameters, all that the type derives from parameters without textures, and
//   void read(MaterialParams&);     of RoughInputs<double>, defined in the .cpp file
//   Rough<N> record() const;        for scalars and lanes
//   void tabulate(double roughness);   called after read(), if members depend on `roughness` by quadrature:
//                                      see roughness_table.h
// For bounds, the functions above are called for each combination of the smallest and the largest values of
// the textured parameters. They must be monotonic in each of these parameters, or largest at an end.
namespace orrery {

// TexturedInputs of a type, or an empty class if no parameter of the type may be textured.
template <template <class> class Record, class T>
struct TexturedInputsChoice {
  struct type {};
};
template <template <class> class Record, class T>
requires Texturable<Record>
struct TexturedInputsChoice<Record, T> {
  using type = TexturedInputs<Record, T>;
};
template <template <class> class Record, class T>
using TexturedInputsOf = typename TexturedInputsChoice<Record, T>::type;

// Materials of one type in the render's precision, and a loop over the registers that contain surfaces with
// these materials.
template <template <class> class Record, class T>
class MaterialRecords : public MaterialKernel<T> {
 public:
  using N = Lanes<T>;

  MaterialRecords(std::span<const Record<double>> records, int first) : first_(first) {
    for (const auto& record : records) records_.push_back(convert_record<Record, T, double>(record));
  }
  // Called before the first use of the kernel, if the materials use textures.
  void use_textures(std::unique_ptr<const TexturedInputsOf<Record, T>> textured) {
    textured_ = std::move(textured);
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
      if (!any(mine)) continue;
      Record<N> record = fetch_records<Record, T>(records_, material - first_, mine);
      if constexpr (Texturable<Record>)
        if (textured_) {  // copies, so that untextured records can stay in registers
          const Record<N> plain = record;
          const Record<N> replaced = textured_->replaced(surface, i, material - first_, mine, plain);
          record = replaced;
        }
      visit(i, mine, record);
    }
  }

 private:
  std::vector<Record<T>> records_;
  std::unique_ptr<const TexturedInputsOf<Record, T>> textured_;
  int first_;
};

template <template <class> class Record, template <class> class Kernel>
class MaterialSetOf final : public MaterialSet {
 public:
  void add(Params& params, const TextureNames& textures) override {
    if constexpr (Texturable<Record>) {
      Inputs inputs{};
      MaterialParams p(params, &textures, reinterpret_cast<double*>(&inputs));
      inputs.read(p);
      tabulate(inputs);
      if (p.fields().size() > fields_.size()) fields_ = p.fields();
      inputs_.push_back(inputs);
      uses_.push_back(p.uses());
      records_.push_back(inputs.record());
      extremes_.push_back(extremes_of(inputs, p.uses()));
      tables_.push_back(table_of(inputs, p.uses()));
    } else {
      records_.push_back(Record<double>::read(params));
    }
  }
  int size() const override { return static_cast<int>(records_.size()); }
  std::vector<TextureUse> texture_uses(int index) const override {
    if constexpr (Texturable<Record>)
      return uses_[static_cast<std::size_t>(index)];
    else
      return {};
  }
  MaterialTraits traits() const override {
    MaterialTraits all;
    for (int i = 0; i < size(); ++i)
      for (const auto& record : records_of(i)) all |= record.traits();
    return all;
  }
  RoundingLimit rounding(int index) const override {
    RoundingLimit strictest;
    if constexpr (requires(const Record<double>& record) { record.rounding(); })
      for (const auto& record : records_of(index))
        if (const RoundingLimit limit = record.rounding(); limit.epsilon < strictest.epsilon)
          strictest = limit;
    return strictest;
  }
  double mirrored_share(int index) const override {
    double most = 0;
    if constexpr (requires(const Record<double>& record) { record.mirrored_share(); })
      for (const auto& record : records_of(index)) most = std::max(most, record.mirrored_share());
    return most;
  }
  double max_albedo(int index) const override {
    if constexpr (requires(const Record<double>& record) { record.max_albedo(); }) {
      double most = 0;
      for (const auto& record : records_of(index)) most = std::max(most, record.max_albedo());
      return most;
    } else {
      return 1;
    }
  }
  ReflectionLimits limits(int index) const override {
    if constexpr (requires(const Record<double>& record) { record.limits(); }) {
      ReflectionLimits all{Vec3d(0), Vec3d(0), Vec3d(0), false, Vec3d(0)};
      for (const auto& record : records_of(index)) {
        const ReflectionLimits own = record.limits();
        all = {largest(all.ambient, own.ambient), largest(all.light, own.light),
               largest(all.albedo, own.albedo), all.specular || own.specular,
               largest(all.transmitted, own.transmitted)};
      }
      return all;
    } else {
      return {};
    }
  }
  std::optional<Medium> medium(int index) const override {
    const Record<double>& record = records_[static_cast<std::size_t>(index)];
    if constexpr (requires { record.medium(); })
      return record.medium();
    else
      return std::nullopt;
  }
  MaterialKernelPtr<float> kernel(float, int first) const override { return make_kernel<float>(first); }
  MaterialKernelPtr<double> kernel(double, int first) const override { return make_kernel<double>(first); }

 private:
  template <template <class> class R>
  struct InputsOf {
    using type = char;
  };
  template <template <class> class R>
  requires Texturable<R>
  struct InputsOf<R> {
    using type = typename R<double>::template Inputs<double>;
  };
  using Inputs = typename InputsOf<Record>::type;

  // Computes the members that depend on `roughness`, or copies them from the last material, because thousands
  // of materials of a model often have the same roughness.
  void tabulate(Inputs& inputs) const {
    if constexpr (TabulatesRoughnessOnly<Inputs>)
      if (!inputs_.empty() && inputs_.back().roughness == inputs.roughness) {
        const double* const end = reinterpret_cast<const double*>(&inputs_.back() + 1);
        std::copy(&inputs_.back().roughness + 1, end, &inputs.roughness + 1);
        return;
      }
    if constexpr (Tabulated<Inputs>) inputs.tabulate(inputs.roughness);
  }

  // Returns the record of a material, or the records with extreme values if the material is textured.
  std::span<const Record<double>> records_of(int index) const {
    const auto i = static_cast<std::size_t>(index);
    if constexpr (Texturable<Record>)
      if (!extremes_[i].empty()) return extremes_[i];
    return {&records_[i], 1};
  }

  // Returns the records for each combination of the smallest and the largest values of the textured
  // parameters. Returns an empty list if there are no textures.
  std::vector<Record<double>> extremes_of(const Inputs& inputs, const std::vector<TextureUse>& uses) const {
    std::vector<Record<double>> records;
    if constexpr (Texturable<Record>) {
      if (uses.empty()) return records;
      for (std::size_t choice = 0; choice < std::size_t{1} << uses.size(); ++choice) {
        Inputs extreme = inputs;
        for (std::size_t k = 0; k < uses.size(); ++k) {
          const TexturedField field = fields_[static_cast<std::size_t>(uses[k].slot)];
          const Vec3d value = choice >> k & 1 ? uses[k].most : uses[k].least;
          std::memcpy(reinterpret_cast<double*>(&extreme) + field.first, &value,
                      field.count * sizeof(double));
        }
        if constexpr (Tabulated<Inputs>)
          if (extreme.roughness != inputs.roughness) extreme.tabulate(extreme.roughness);
        records.push_back(extreme.record());
      }
    }
    return records;
  }

  // Returns the table of a textured roughness, or an empty table.
  RoughnessTable<double> table_of(const Inputs& inputs, const std::vector<TextureUse>& uses) const {
    if constexpr (Tabulated<Inputs>)
      for (const TextureUse& use : uses)
        if (is_roughness(inputs, fields_[static_cast<std::size_t>(use.slot)]))
          return RoughnessTable<double>(inputs, use.least.x, use.most.x);
    return {};
  }

  template <class T>
  MaterialKernelPtr<T> make_kernel(int first) const {
    auto kernel = std::make_unique<Kernel<T>>(std::span<const Record<double>>(records_), first);
    if constexpr (Texturable<Record>) {
      if (std::any_of(uses_.begin(), uses_.end(), [](const auto& uses) { return !uses.empty(); }))
        kernel->use_textures(
            std::make_unique<const TexturedInputs<Record, T>>(inputs_, uses_, fields_, tables_));
    }
    return kernel;
  }

  std::vector<Record<double>> records_;
  // Empty unless Texturable<Record>; otherwise by material, except for `fields_`, by slot.
  std::vector<Inputs> inputs_;
  std::vector<std::vector<TextureUse>> uses_;
  std::vector<std::vector<Record<double>>> extremes_;
  std::vector<RoughnessTable<double>> tables_;
  std::vector<TexturedField> fields_;
};

template <template <class> class Record, template <class> class Kernel>
std::unique_ptr<MaterialSet> make_material_set() {
  return std::make_unique<MaterialSetOf<Record, Kernel>>();
}

}  // namespace orrery
