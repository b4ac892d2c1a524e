#include "core/environments/formula.h"
#include "core/params/params.h"

namespace orrery {
namespace {

// Uniform radiance, equivalent to the scene's `background`.
template <class N>
struct Constant {
  Vec3<N> everywhere;

  static Constant<double> read(Params& p) {
    return {p.color("radiance", "Radiance of rays that leave the scene.", Vec3d(1))};
  }
  Vec3d constant() const { return Vec3d(everywhere); }
  Vec3<N> most() const { return everywhere; }
  Vec3<N> least() const { return everywhere; }
  Vec3<N> radiance(const Vec3<N>&) const { return everywhere; }
};

}  // namespace

EnvironmentType constant_type() {
  return {"constant", "The same radiance from all directions.", read_formula<Constant>};
}

}  // namespace orrery
