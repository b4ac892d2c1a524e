#include "core/techniques/registry.h"

#include <array>

namespace orrery {

template <class T>
using MakeTracer = TracerPtr<T>(const World<T>&, const Plan&);
MakeTracer<float> make_raycast, make_whitted;
MakeTracer<double> make_raycast, make_whitted;

std::span<const TechniqueType> technique_types() {
  static constexpr std::array kTypes{
      TechniqueType{"raycast", "Camera and shadow rays alone (Appel 1968).", false, make_raycast, make_raycast},
      TechniqueType{"whitted", "Mirrored and refracted rays as well (Whitted 1980).", true, make_whitted,
                    make_whitted},
  };
  return kTypes;
}

}  // namespace orrery
