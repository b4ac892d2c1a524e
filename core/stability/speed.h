#pragma once

#include <functional>
#include <string>
#include <vector>

namespace orrery {

// Methods that do the same, by what they take on this machine.
struct SpeedGroup {
  struct Method {
    std::string name;
    double time;        // median over rounds of its CPU time over that of the first method
    std::string error;  // what it is off, with its unit
  };
  std::string name;
  std::vector<Method> methods;  // of the first the time is 1
};

// Measures in rounds in which all methods of a group take turns, in an order that turns round each time;
// `progress` is called after each round of each group, with how many are done of all. REQUIRES: rounds >= 7.
std::vector<SpeedGroup> measure_speed(int rounds, const std::function<void(int done, int all)>& progress);

std::string speed_text(const std::vector<SpeedGroup>& groups);
// A drawing 760 wide with a bar for each method.
std::string svg_of(const std::vector<SpeedGroup>& groups);

}  // namespace orrery
