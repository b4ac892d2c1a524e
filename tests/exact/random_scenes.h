#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace orrery::test {

// Class of random scenes in which rounding matters.
struct SceneClass {
  std::string name;
  nlohmann::json (*make)(Random&);
};
const std::vector<SceneClass>& scene_classes();

}  // namespace orrery::test
