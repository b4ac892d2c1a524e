#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace orrery {

// Returns the command-line flag of a setting or an option: "--max-depth" for "max_depth".
inline std::string flag_of(std::string_view name) {
  std::string flag = "--" + std::string(name);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

}  // namespace orrery
