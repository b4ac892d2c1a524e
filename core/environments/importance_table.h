#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace orrery {

// Discrete 2D distribution over grid cells. draw() selects a row, then a column of that row. Both
// probabilities are multiples of 2^-24, the resolution of the random numbers, so probability() is exact.
class ImportanceTable {
 public:
  // `weights` are row-major and >= 0. The table is empty if all weights are 0. Throws Cancelled.
  ImportanceTable(int width, int height, std::span<const float> weights);

  bool empty() const { return column_ends_.empty(); }
  int width() const { return width_; }
  int height() const { return height_; }

  struct Cell {
    int column, row;
  };
  // Returns the cell that v (row) and u (column) select. Both are in [0, 1) and multiples of 2^-24. REQUIRES:
  // !empty().
  Cell draw(double u, double v) const;
  double probability(const Cell& cell) const;

 private:
  std::span<const std::uint32_t> columns_of(int row) const;

  int width_, height_;
  std::vector<std::uint32_t> row_ends_, column_ends_;  // CDF at the end of each row or column, times 2^24
};

}  // namespace orrery
