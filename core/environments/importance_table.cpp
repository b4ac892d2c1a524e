#include "core/environments/importance_table.h"

#include <algorithm>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

constexpr double kNumbers = 0x1p24;

// Appends the CDF of the weights in units of 2^-24. REQUIRES: `sum` is the sum of the weights, added in this
// order, so that the CDF ends at exactly 2^24. If all weights are 0, `sum` is any positive number.
template <class Weights>
void append_ends(const Weights& weights, double sum, std::vector<std::uint32_t>& ends) {
  double end = 0;
  for (const double weight : weights) {
    end += weight;
    ends.push_back(static_cast<std::uint32_t>(end / sum * kNumbers + 0.5));
  }
}

std::size_t chosen(std::span<const std::uint32_t> ends, double u) {
  const auto number = static_cast<std::uint32_t>(u * kNumbers);
  return static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), number) - ends.begin());
}

double share(std::span<const std::uint32_t> ends, std::size_t i) {
  return (ends[i] - (i > 0 ? ends[i - 1] : 0)) / kNumbers;
}

}  // namespace

ImportanceTable::ImportanceTable(int width, int height, std::span<const float> weights)
    : width_(width), height_(height) {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<double> rows;
  double sum = 0;
  for (int row = 0; row < height; ++row) {
    double of_row = 0;
    for (const float weight : weights.subspan(static_cast<std::size_t>(row) * columns, columns))
      of_row += double{weight};
    rows.push_back(of_row);
    sum += of_row;
  }
  if (!(sum > 0)) return;
  append_ends(rows, sum, row_ends_);
  column_ends_.reserve(weights.size());
  for (int row = 0; row < height; ++row) {
    checkpoint();
    const double of_row = rows[static_cast<std::size_t>(row)];
    append_ends(weights.subspan(static_cast<std::size_t>(row) * columns, columns), of_row > 0 ? of_row : 1,
                column_ends_);
  }
}

std::span<const std::uint32_t> ImportanceTable::columns_of(int row) const {
  const auto width = static_cast<std::size_t>(width_);
  return std::span(column_ends_).subspan(static_cast<std::size_t>(row) * width, width);
}

ImportanceTable::Cell ImportanceTable::draw(double u, double v) const {
  const int row = static_cast<int>(chosen(row_ends_, v));
  return {static_cast<int>(chosen(columns_of(row), u)), row};
}

double ImportanceTable::probability(const Cell& cell) const {
  return share(row_ends_, static_cast<std::size_t>(cell.row)) *
         share(columns_of(cell.row), static_cast<std::size_t>(cell.column));
}

}  // namespace orrery
