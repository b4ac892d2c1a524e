#pragma once

#include <functional>
#include <string>
#include <vector>

namespace orrery {

// Methods for the same task, with their relative CPU times on this machine.
struct SpeedGroup {
  struct Method {
    std::string name;
    double time;        // CPU time / CPU time of the first method, median over rounds
    std::string error;  // text with unit, or "reference"
  };
  std::string name;
  std::vector<Method> methods;  // the first has time 1
};

// Measures all groups, one after another, in rounds. A round runs each method of a group once, in an order
// that alternates between rounds. Calls `progress` after each round, with the number of finished rounds and
// the number of rounds of all groups. Renders on one thread. REQUIRES: rounds >= 7.
std::vector<SpeedGroup> measure_speed(int rounds, const std::function<void(int done, int all)>& progress);

// Returns one line for each group and each method.
std::string speed_text(const std::vector<SpeedGroup>& groups);
// Returns an SVG with a bar for each method, 760 units wide.
std::string svg_of(const std::vector<SpeedGroup>& groups);

}  // namespace orrery
