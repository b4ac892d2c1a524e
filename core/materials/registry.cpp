#include "core/materials/registry.h"

#include <array>

namespace orrery {

using MakeMaterials = std::unique_ptr<MaterialSet>();
MakeMaterials make_reflective, make_refractive, make_rough;

std::span<const MaterialType> material_types() {
  static constexpr std::array kTypes{
      MaterialType{"rough", "Ambient, Lambert diffuse and a Phong or Blinn-Phong highlight.", make_rough},
      MaterialType{"reflective", "A metal mirror coloured by Fresnel's law.", make_reflective},
      MaterialType{"refractive", "Clear glass: mirrors and refracts, may filter light inside.", make_refractive},
  };
  return kTypes;
}

}  // namespace orrery
