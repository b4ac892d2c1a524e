#pragma once

#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "core/materials/material_params.h"
#include "core/materials/roughness_table.h"
#include "core/model/batch.h"
#include "core/model/record.h"

namespace orrery {

// Returns the number of the member `roughness` of tabulated inputs.
template <class Inputs>
std::size_t roughness_field(const Inputs& inputs) {
  using T = std::remove_cvref_t<decltype(inputs.roughness)>;
  return static_cast<std::size_t>(&inputs.roughness - reinterpret_cast<const T*>(&inputs));
}
template <class Inputs>
bool is_roughness(const Inputs& inputs, const TexturedField& field) {
  return field.first == roughness_field(inputs);
}

template <template <class> class Record>
concept Texturable = requires {
  typename Record<double>::template Inputs<double>;
};

// Inputs of the materials of one type, some of which are textured.
template <template <class> class Record, class T>
class TexturedInputs {
 public:
  using N = Lanes<T>;
  template <class M>
  using Inputs = typename Record<M>::template Inputs<M>;

  // `uses` and `tables`: by material. `fields`: by slot.
  TexturedInputs(std::span<const Inputs<double>> inputs, std::span<const std::vector<TextureUse>> uses,
                 std::vector<TexturedField> fields, std::span<const RoughnessTable<double>> tables)
      : fields_(std::move(fields)) {
    for (const auto& of_material : uses) {
      slots_.push_back(0);
      for (const TextureUse& use : of_material) slots_.back() |= IndexOf<T>(1) << use.slot;
    }
    for (const auto& table : tables) tables_.emplace_back(table);
    for (const auto& one : inputs) inputs_.push_back(convert_record<Inputs, T, double>(one));
  }

  // Returns `plain` with the records of textured materials in the lanes `mine`. `index` is the number of the
  // material within its set.
  [[gnu::noinline]] Record<N> replaced(const SurfaceBatch<T>& surface, int i, const IndexLanes<T>& index,
                                       const MaskOf<N>& mine, const Record<N>& plain) const {
    IndexLanes<T> slots(0);
    for (std::size_t lane = 0; lane < N::size(); ++lane)
      if (mine[lane]) slots[lane] = slots_[static_cast<std::size_t>(index[lane])];
    const auto textured = mask_cast<N>(slots != 0);
    if (!any(textured)) return plain;
    constexpr std::size_t kCount = kFields<Inputs, T>;
    const Inputs<N> fetched = fetch_records<Inputs, T>(inputs_, index, mine);
    std::array<N, kCount> fields;
    std::memcpy(static_cast<void*>(fields.data()), &fetched, sizeof fetched);
    for (std::size_t slot = 0; slot < fields_.size() && slot < surface.textured.size(); ++slot) {
      const auto set = mask_cast<N>((slots & IndexLanes<T>(IndexOf<T>(1) << slot)) != 0);
      if (!any(set)) continue;
      const Vec3<N> value = surface.textured[slot].at(i);
      for (std::size_t k = 0; k < fields_[slot].count; ++k) {
        N& field = fields[fields_[slot].first + k];
        field = select(set, value[k], field);
      }
    }
    if constexpr (Tabulated<Inputs<double>>) interpolate(index, mine, fields);
    Inputs<N> inputs;
    std::memcpy(static_cast<void*>(&inputs), fields.data(), sizeof inputs);
    return select_record(textured, inputs.record(), plain);
  }

 private:
  // Sets the members that depend on a textured roughness.
  void interpolate(const IndexLanes<T>& index, const MaskOf<N>& mine,
                   std::array<N, kFields<Inputs, T>>& fields) const {
    const std::size_t roughness = roughness_field(inputs_.front());
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      if (!mine[lane]) continue;
      const RoughnessTable<T>& table = tables_[static_cast<std::size_t>(index[lane])];
      if (table.empty()) continue;
      table.interpolate(fields[roughness][lane],
                        [&](std::size_t k, T value) { fields[roughness + 1 + k][lane] = value; });
    }
  }

  static Record<N> select_record(const MaskOf<N>& mask, const Record<N>& yes, const Record<N>& no) {
    std::array<N, kFields<Record, T>> a, b;
    std::memcpy(static_cast<void*>(a.data()), &yes, sizeof yes);
    std::memcpy(static_cast<void*>(b.data()), &no, sizeof no);
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = select(mask, a[k], b[k]);
    Record<N> chosen;
    std::memcpy(static_cast<void*>(&chosen), a.data(), sizeof chosen);
    return chosen;
  }

  std::vector<RoughnessTable<T>> tables_;  // by material; empty unless the roughness is textured
  std::vector<Inputs<T>> inputs_;
  std::vector<IndexOf<T>> slots_;
  std::vector<TexturedField> fields_;
};

}  // namespace orrery
