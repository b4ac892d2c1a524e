#include <limits>

#include "core/lights/light_of.h"
#include "core/params/params.h"

namespace orrery {
namespace {

class Directional final : public LightOf<Directional> {
 public:
  explicit Directional(Params& p)
      : from_(p.direction("from", "Direction toward the light.")),
        intensity_(p.color("intensity", "A white surface that faces intensity 1 reads 1.", Vec3d(1))) {}

  template <class T>
  void fill(const SurfaceBatch<T>&, const Groups& groups, LightBatch<T>& out) const {
    using N = Lanes<T>;
    const Vec3<N> from(Vec3<T>{from_}), incident(Vec3<T>{intensity_});
    for (const int i : groups) {
      out.shadow.direction.put(i, from);
      out.shadow.t_max.put(i, N(std::numeric_limits<T>::infinity()));
      out.incident.put(i, incident);
    }
  }
  Vec3d intensity() const override { return intensity_; }
  bool directional() const override { return true; }

 private:
  Vec3d from_, intensity_;
};

}  // namespace

LightType directional_type() {
  return {"directional", "Parallel light from infinitely far away.", make_light<Directional>};
}

}  // namespace orrery
