#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace orrery {

// Cells of a grid drawn in proportion to weights: a row first, then a column of it. Probabilities are whole
// shares of the 2^24 random numbers that decide each, so that they are exactly those with which cells are
// drawn.
class ImportanceTable {
 public:
  // `weights`: row by row, at least 0. All 0: the table is empty.
  ImportanceTable(int width, int height, std::span<const float> weights);

  bool empty() const { return column_ends_.empty(); }
  int width() const { return width_; }
  int height() const { return height_; }

  struct Cell {
    int column, row;
  };
  // The cell that u and v in [0, 1), multiples of 2^-24, choose. REQUIRES: !empty().
  Cell draw(double u, double v) const;
  double probability(const Cell& cell) const;

 private:
  std::span<const std::uint32_t> columns_of(int row) const;

  int width_, height_;
  std::vector<std::uint32_t> row_ends_, column_ends_;  // the first number beyond each one's own
};

}  // namespace orrery
