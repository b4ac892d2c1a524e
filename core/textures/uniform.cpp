#include "core/params/params.h"
#include "core/textures/texture_of.h"

namespace orrery {
namespace {

// The same colour everywhere.
template <class N>
struct Uniform {
  Vec3<N> color;

  Vec3<N> value(const Vec3<N>&, const Vec3<N>&) const { return color; }
  TextureBounds bounds() const { return {color, color}; }
  double detail() const { return 1; }
};

std::shared_ptr<const Texture> read_uniform(Params& p, const AssetSource&) {
  return std::make_shared<const TextureOf<Uniform>>(Uniform<double>{p.color("color", "Colour.", Vec3d(1))});
}

}  // namespace

TextureType uniform_type() {
  return {"uniform", "One colour, which vertex colours may multiply.", read_uniform};
}

}  // namespace orrery
