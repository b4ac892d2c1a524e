#include "core/stability/pictures.h"

#include "core/plan/plan.h"

namespace orrery {

RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request) {
  const PreparedScene prepared(scene);
  ThreadExecutor executor(1);
  return render_frame(prepared, settle(prepared, make_plan(*scene, request)), FilmStorage::linear32,
                      executor);
}

std::vector<float> values_of(const Film& film) {
  const Image image = film.image(PixelFormat::linear32);
  return {image.values().begin(), image.values().end()};
}

SampledTile::SampledTile(const std::shared_ptr<const Scene>& scene, const RenderRequest& request)
    : prepared_(scene),
      plan_(settle(prepared_, make_plan(*scene, request))),
      executor_(1),
      ready_(threads_backend(executor_)->prepare(prepared_, plan_, stats_, {})),
      film_(plan_->width, plan_->height, FilmStorage::sums) {
  sums_.samples = 0;
}

const TileSums& SampledTile::add(int samples) {
  const TileView tile{.x0 = 0,
                      .y0 = 0,
                      .width = plan_->width,
                      .height = plan_->height,
                      .first_sample = sums_.samples,
                      .samples = samples};
  stats_ = {};
  ready_->render(std::span(&tile, 1), film_, stats_, {});
  film_.take(tile, sums_);
  return sums_;
}

}  // namespace orrery
