#include "core/lights/registry.h"

#include <array>

namespace orrery {

using MakeLight = std::unique_ptr<Light>(Params&);
MakeLight make_directional, make_point, make_spot;

std::span<const LightType> light_types() {
  static constexpr std::array kTypes{
      LightType{"directional", "Parallel light from infinitely far away.", make_directional},
      LightType{"point", "Light from one point in all directions.", make_point},
      LightType{"spot", "Light from one point in a cone.", make_spot},
  };
  return kTypes;
}

}  // namespace orrery
