#pragma once

#include <functional>
#include <string>
#include <vector>

namespace orrery {

// Methods for the same task, with their relative time on this machine.
struct SpeedGroup {
  struct Method {
    std::string name;
    double time;        // median over rounds of CPU time over that of the first method
    std::string error;  // with its unit
  };
  std::string name;
  std::vector<Method> methods;  // the first has time 1
};

// Measures in rounds in which all methods of a group take turns, in alternating order. Calls `progress` after
// each round of each group with the number of finished rounds and of all rounds. REQUIRES: rounds >= 7.
std::vector<SpeedGroup> measure_speed(int rounds, const std::function<void(int done, int all)>& progress);

std::string speed_text(const std::vector<SpeedGroup>& groups);
// Draws a bar for each method, 760 units wide.
std::string svg_of(const std::vector<SpeedGroup>& groups);

}  // namespace orrery
