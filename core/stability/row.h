#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

// Stability rows. Each row compares the error of a known numerical method with the error of the method that
// orrery uses for the same quantity.
namespace orrery {

// Line chart. A logarithmic y axis shows values of 0 in a lane below the axis.
struct LineChart {
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;  // by increasing x
  };
  std::string name;  // file name: lower-case letters, digits, hyphens
  std::string title, x, y;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

// Errors of both methods in the row's unit, finite and not negative. 0: exact.
struct StabilityFigures {
  double known, ours;
  std::optional<LineChart> chart = {};
};

struct StabilityRow {
  const char* id;        // in docs/stability-catalogue.md; used by tests
  const char* name;      // a few words
  const char* quantity;  // "quantity: error that is measured"
  const char* unit;      // "1" for a ratio
  // Known method with its source, and a lower bound of the error of this method.
  const char* known;
  double known_at_least;
  // Method that orrery uses, and an upper bound of the error of this method.
  const char* ours;
  double ours_at_most;
  // Pure function. Uses only IEEE operations and square roots, so results are the same on every machine.
  StabilityFigures (*measure)();
};

struct StabilityResult {
  StabilityRow row;
  StabilityFigures figures;

  bool holds() const { return figures.ours <= row.ours_at_most; }
};

}  // namespace orrery
