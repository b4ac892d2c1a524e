#include "core/lights/attenuation.h"
#include "core/lights/light_of.h"
#include "core/params/params.h"

namespace orrery {
namespace {

class Point final : public LightOf<Point> {
 public:
  explicit Point(Params& p)
      : position_(p.point("position", "Where the light is, in metres.")),
        intensity_(p.color("intensity", "A white surface that faces intensity 1 reads 1.", Vec3d(1))),
        attenuation_(Attenuation::read(p)) {}

  template <class T>
  void fill(const SurfaceBatch<T>& surface, const Groups& groups, LightBatch<T>& out) const {
    using N = Lanes<T>;
    const Vec3<N> position(Vec3<T>{position_}), intensity(Vec3<T>{intensity_});
    for (const int i : groups) {
      const Vec3<N> toward = position - surface.position.at(i);
      const N distance = length(toward);
      out.shadow.direction.put(i, toward / distance);
      out.shadow.t_max.put(i, select(distance > N(T(0)), distance, N(T(-1))));
      out.incident.put(i, intensity * attenuation_.at(distance));
    }
  }
  Vec3d intensity() const override { return intensity_; }

 private:
  Vec3d position_, intensity_;
  Attenuation attenuation_;
};

}  // namespace

LightType point_type() { return {"point", "Light from one point in all directions.", make_light<Point>}; }

}  // namespace orrery
