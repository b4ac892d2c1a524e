#include "core/textures/checker.h"

#include "core/params/params.h"

namespace orrery {
namespace {

std::shared_ptr<const Texture> read_checker(Params& p, const AssetSource&) {
  const Vec3d even = p.coefficient("even", "Value of cells with an even sum of cell numbers.", Vec3d(1));
  const Vec3d odd = p.coefficient("odd", "Value of the other cells.", Vec3d(0));
  return std::make_shared<const TextureOf<Checker>>(Checker<double>{even, odd});
}

}  // namespace

TextureType checker_type() {
  return {"checker", "Cells of side 1 in two colours, averaged exactly over the pixel.", read_checker};
}

}  // namespace orrery
