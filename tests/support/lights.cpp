#include "tests/support/lights.h"

#include "tests/support/batches.h"

namespace orrery::test {

template <class T>
IncidentLight<T> arrival(const Json& light, const Vec3<T>& at) {
  const auto scene = load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"),
                                     Json{{"lights", Json::array({light})}}));
  const auto surface = std::make_unique<SurfaceBatch<T>>();
  const auto out = std::make_unique<LightBatch<T>>();
  const auto slots = std::make_unique<Array<IndexOf<T>>>();
  const Draws draws(0, TileView{0, 0, kTileSide, kTileSide}, 0);
  for (int i = 0; i < kWidth<T>; ++i) surface->position.set(i, at);
  const LightPlace& place = scene->lights.front();
  scene->light_sets[place.set]->kernel(T())->sample(*surface, {place.index}, PathDraws<T>{draws, *slots, 0},
                                                    LaneGroups::single(0), *out);
  return {out->shadow.direction[0], out->shadow.t_max[0], out->incident[0]};
}

template IncidentLight<float> arrival(const Json&, const Vec3<float>&);
template IncidentLight<double> arrival(const Json&, const Vec3<double>&);

}  // namespace orrery::test
