#include "core/lights/attenuation.h"
#include "core/lights/light_of.h"
#include "core/math/angles.h"
#include "core/params/params.h"

namespace orrery {
namespace {

constexpr Range kHalfAngle = {.min = 0, .max = 180};

// Full inside the inner cone, nothing outside the outer one, a smooth step in the cosine between.
class Spot final : public LightOf<Spot> {
 public:
  explicit Spot(Params& p)
      : position_(p.point("position", "Where the light is, in metres.")),
        direction_(p.direction("direction", "Where the beam goes.")),
        intensity_(p.color("intensity", "A white surface that faces intensity 1 reads 1.", Vec3d(1))),
        attenuation_(Attenuation::read(p)) {
    const double inner = p.number("inner_degrees", "Half angle of the full beam.", kHalfAngle, 15.0);
    const double outer = p.number("outer_degrees", "Half angle where the beam ends.", kHalfAngle, 30.0);
    if (inner > outer) p.fail("inner_degrees", "expected at most outer_degrees");
    cos_inner_ = sine_cosine_degrees(inner).cosine;
    cos_outer_ = sine_cosine_degrees(outer).cosine;
  }

  template <class T>
  void fill(const SurfaceBatch<T>& surface, const Groups& groups, LightBatch<T>& out) const {
    using N = Lanes<T>;
    const Vec3<N> position(Vec3<T>{position_}), axis(Vec3<T>{direction_}), intensity(Vec3<T>{intensity_});
    for (const int i : groups) {
      const Vec3<N> toward = position - surface.position.at(i);
      const N distance = length(toward);
      const Vec3<N> direction = toward / distance;
      const N beam = cone(N(-dot(direction, axis)));
      out.shadow.direction.put(i, direction);
      out.shadow.t_max.put(i, select(distance > N(T(0)) && beam > N(T(0)), distance, N(T(-1))));
      out.incident.put(i, intensity * (attenuation_.at(distance) * beam));
    }
  }
  Vec3d intensity() const override { return intensity_; }

 private:
  // Equal angles make the quotient infinite or NaN: a step, full at the angle itself.
  template <class N>
  N cone(const N& cosine) const {
    using T = ScalarOf<N>;
    const N x = (cosine - T(cos_outer_)) / N(T(cos_inner_ - cos_outer_));
    const N unit = max_first(N(T(0)), min_first(N(T(1)), x));
    return select(cosine >= N(T(cos_inner_)), N(T(1)), N(unit * unit * (T(3) - T(2) * unit)));
  }

  Vec3d position_, direction_, intensity_;
  Attenuation attenuation_;
  double cos_inner_, cos_outer_;
};

}  // namespace

LightType spot_type() { return {"spot", "Light from one point in a cone.", make_light<Spot>}; }

}  // namespace orrery
