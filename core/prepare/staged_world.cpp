#include "core/prepare/staged_world.h"

#include "core/base/clock.h"
#include "core/base/task_scope.h"
#include "core/model/technique.h"
#include "core/occlusion/cutouts.h"
#include "core/occlusion/reordered.h"
#include "core/prepare/occlusion_samples.h"
#include "core/raster/screen.h"

namespace orrery {
namespace {

template <class T>
PredictorPtr<T> network_for(PreparedScene::Parts& parts, const World<T>& world, const Plan& plan,
                            double& build_ms, std::stop_token stop) {
  const auto lock = lock_unless(parts.trying, stop);
  PredictorPtr<T>& network = made_of<T>(parts).network;
  if (!network) {
    const auto start = Clock::now();
    network = network_predictor<T>(sample_occlusion(world, plan, stop));
    build_ms += milliseconds_since(start);
  }
  return network;
}

// Shapes are needed only for their parameters.
template <class T>
World<T> rasterized_world(PreparedScene::Parts& parts, const Plan& plan, double& build_ms,
                          std::stop_token stop) {
  World<T> world = plan.fields.parameters
                       ? world_for<T>(parts, *plan.accelerator, plan.exposure(), build_ms, stop)
                       : lighting_for<T>(parts, *plan.accelerator, build_ms, stop);
  const auto start = Clock::now();
  const TaskScope scope({TaskScope::current().memory, &stop});
  world.screen = make_screen(parts.scene, plan);
  build_ms += milliseconds_since(start);
  return world;
}

}  // namespace

template <class T>
World<T> staged_world(PreparedScene::Parts& parts, const SettledPlan& settled, double& build_ms,
                      std::stop_token stop) {
  const Plan& plan = *settled;
  if (plan.technique->rasterizes) return rasterized_world<T>(parts, plan, build_ms, stop);
  const World<T> bare = world_for<T>(parts, *plan.accelerator, plan.exposure(), build_ms, stop);
  const PrimitiveList<T>& primitives = bare.geometry->primitives;
  const bool timed = plan.shutter > 0;
  auto asked = plan.reorder ? reordered(bare.accelerator, timed) : bare.accelerator;
  if (parts.scene->facts.cutouts)
    return {bare.geometry, with_cutouts(bare.geometry, std::move(asked), timed)};
  if (plan.prediction == Prediction::last)
    asked = predicted_by_last(primitives, std::move(asked));
  else if (plan.prediction == Prediction::random)
    asked = predicted(primitives, std::move(asked), random_predictor<T>(static_cast<int>(primitives.size())));
  else if (plan.prediction == Prediction::network)
    asked = predicted(primitives, std::move(asked), network_for(parts, bare, plan, build_ms, stop));
  return {bare.geometry, asked};
}

template World<float> staged_world(PreparedScene::Parts&, const SettledPlan&, double&, std::stop_token);
template World<double> staged_world(PreparedScene::Parts&, const SettledPlan&, double&, std::stop_token);

}  // namespace orrery
