#pragma once

#include <array>
#include <cstring>
#include <span>

#include "core/model/batch.h"

// Records: structs with only numeric members, written once as `template <class N> struct Sphere { Vec3<N>
// center; N radius; ... }`. The same struct stores one shape in double precision as read, one shape in the
// render's precision, or one shape per lane. All lanes may store the same shape.
namespace orrery {

template <template <class> class Record, class N>
inline constexpr std::size_t kFields = sizeof(Record<N>) / sizeof(N);

template <template <class> class Record, class To, class From>
Record<To> convert_record(const Record<From>& from) {
  static_assert(kFields<Record, To> == kFields<Record, From>);
  std::array<From, kFields<Record, From>> source;
  std::memcpy(source.data(), &from, sizeof from);
  std::array<To, kFields<Record, To>> target;
  for (std::size_t i = 0; i < source.size(); ++i) target[i] = static_cast<To>(source[i]);
  Record<To> to;
  std::memcpy(static_cast<void*>(&to), target.data(), sizeof to);
  return to;
}

template <template <class> class Record, class T>
Record<Lanes<T>> broadcast_record(const Record<T>& one) {
  return convert_record<Record, Lanes<T>, T>(one);
}

// Returns table[index[i]] in lane i if `mask` is set, else table[other].
template <template <class> class Record, class T, class Table>
Record<Lanes<T>> gather_records(const Table& table, const IndexLanes<T>& index, const MaskOf<Lanes<T>>& mask,
                                IndexOf<T> other) {
  constexpr std::size_t kCount = kFields<Record, T>;
  alignas(64) std::array<std::array<T, static_cast<std::size_t>(kWidth<T>)>, kCount> columns;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(kWidth<T>); ++lane) {
    std::array<T, kCount> row;
    const Record<T>& one = table[static_cast<std::size_t>(mask[lane] ? index[lane] : other)];
    std::memcpy(row.data(), &one, sizeof row);
    for (std::size_t field = 0; field < kCount; ++field) columns[field][lane] = row[field];
  }
  std::array<Lanes<T>, kCount> lanes;
  for (std::size_t field = 0; field < kCount; ++field)
    lanes[field] = Lanes<T>(columns[field].data(), stdx::vector_aligned);
  Record<Lanes<T>> result;
  std::memcpy(static_cast<void*>(&result), lanes.data(), sizeof result);
  return result;
}

// Returns table[index[i]] in lane i if `mask` is set, else any valid record. REQUIRES: any(mask). Rays of one
// register mostly hit the same primitive, whose record is broadcast without a gather. `table` is a span or
// another type whose operator[] returns a Record<T>.
template <template <class> class Record, class T, class Table>
[[gnu::always_inline]] inline Record<Lanes<T>> fetch_records(const Table& table, const IndexLanes<T>& index,
                                                             const MaskOf<Lanes<T>>& mask) {
  const IndexOf<T> first = index[static_cast<std::size_t>(stdx::find_first_set(mask))];
  if (all(!mask || mask_cast<Lanes<T>>(index == first)))
    return broadcast_record<Record, T>(table[static_cast<std::size_t>(first)]);
  return gather_records<Record, T>(table, index, mask, first);
}

}  // namespace orrery
