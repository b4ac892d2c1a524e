#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

// Where numerical methods fail: rows that measure a known method beside the one that this program uses.
namespace orrery {

// A few lines over one axis. A logarithmic y axis shows values of 0 in a lane below it.
struct LineChart {
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;  // by rising x
  };
  std::string name;  // of the file: small letters, digits, hyphens
  std::string title, x, y;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

// Errors of both methods, in the row's unit: 0 is the best, each is finite and at least 0.
struct StabilityFigures {
  double known, ours;
  std::optional<LineChart> chart = {};
};

struct StabilityRow {
  const char* id;        // that the tests name as well
  const char* name;      // a few words
  const char* quantity;  // what is computed, and what of it is measured
  const char* unit;
  // The known method with its source, and what it reaches at least.
  const char* known;
  double known_at_least;
  // The method of this program, and what it keeps.
  const char* ours;
  double ours_at_most;
  // A pure function: the same figures on every machine, since it uses IEEE operations and square roots alone.
  StabilityFigures (*measure)();
};

struct StabilityResult {
  StabilityRow row;
  StabilityFigures figures;

  bool holds() const { return figures.ours <= row.ours_at_most; }
};

}  // namespace orrery
