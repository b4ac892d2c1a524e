#include "tests/support/tracing.h"

#include <cassert>

#include "core/prepare/geometry.h"
#include "tests/support/batches.h"

namespace orrery::test {

// Accelerator decorator that records the rays of all calls. Each call receives one whole batch, because the
// batches of these tests are no larger than a slice.
class Tracing::Recorder final : public Accelerator<double> {
 public:
  explicit Recorder(AcceleratorPtr<double> real) : real_(std::move(real)) {}

  AcceleratorFacts facts() const override { return real_->facts(); }
  void closest(const RayBatch<double>& rays, const LaneGroups& groups, HitBatch<double>& hits,
               AcceleratorCounts& counts) const override {
    std::vector<Ray<double>> generation;
    collect(rays, groups, generation);
    generations.push_back(std::move(generation));
    real_->closest(rays, groups, hits, counts);
  }
  void occlude(RayBatch<double>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    collect(rays, groups, shadow);
    real_->occlude(rays, groups, counts);
  }

  mutable Generations generations;
  mutable std::vector<Ray<double>> shadow;

 private:
  static void collect(const RayBatch<double>& rays, const LaneGroups& groups,
                      std::vector<Ray<double>>& into) {
    for (const int first : groups)
      for (int i = first; i < first + kWidth<double>; ++i)
        if (rays.t_max[i] > 0) into.push_back({rays.origin[i], rays.direction[i]});
  }
  AcceleratorPtr<double> real_;
};

Tracing::Tracing(const Json& scene, RenderRequest request) : Tracing(load(scene), std::move(request)) {}

Tracing::Tracing(const std::shared_ptr<const Scene>& scene, RenderRequest request, Ledger ledger) {
  request.precision = Precision::double_precision;
  request.slice = kBatch;
  plan_ = make_plan(*scene, request);
  if (ledger == Ledger::weights) plan_.cut_range = plan_.cut_range_beyond = Vec3d(1);
  world_.geometry = make_geometry<double>(scene, *plan_.accelerator);
  auto recorder = std::make_unique<Recorder>(build(*plan_.accelerator, world_.geometry->primitives));
  recorder_ = recorder.get();
  world_.accelerator = std::move(recorder);
  tracer_ = make_tracer(*plan_.technique, world_, plan_);
}

Tracing::~Tracing() = default;

TraceOutput Tracing::trace(const Ray<double>& ray) { return trace(std::vector<Ray<double>>{ray}).front(); }

std::vector<TraceOutput> Tracing::trace(const std::vector<Ray<double>>& rays, int sample) {
  assert(rays.size() <= static_cast<std::size_t>(kBatch));
  const auto batch = std::make_unique<RayBatch<double>>();
  const auto result = std::make_unique<TraceResult<double>>();
  fill_batch(std::span<const Ray<double>>(rays), std::numeric_limits<double>::infinity(), *batch);
  batch->count = kBatch;
  recorder_->generations.clear();
  recorder_->shadow.clear();
  tracer_->trace(*batch, Draws(plan_.seed, TileView{0, 0, kTileSide, kTileSide}, sample), *result, counts_);
  if (tracer_->has_emission_pass())
    tracer_->trace_emission_only(*batch, LaneGroups::covering(0, kBatch, kWidth<double>), 1, *result,
                                 counts_);
  std::vector<TraceOutput> answers;
  for (int i = 0; i < static_cast<int>(rays.size()); ++i)
    answers.push_back({result->radiance[i], result->omitted[i], max_component(result->omitted[i])});
  return answers;
}

const Tracing::Generations& Tracing::rays() const { return recorder_->generations; }
const std::vector<Ray<double>>& Tracing::shadow_rays() const { return recorder_->shadow; }

namespace {

Estimate estimate(const std::shared_ptr<const Scene>& scene, const Vec3d& from, const Vec3d& toward,
                  const RenderRequest& request, int samples) {
  const std::vector<Ray<double>> rays(kBatch, Ray<double>{from, safe_normalize(toward - from)});
  Tracing tracing(scene, request);
  std::vector<double> means(kBatch);
  for (int sample = 0; sample < samples; ++sample) {
    const std::vector<TraceOutput> answers = tracing.trace(rays, sample);
    for (std::size_t i = 0; i < means.size(); ++i) means[i] += answers[i].radiance.x / samples;
  }
  double sum = 0, squares = 0;
  for (const double mean : means) {
    sum += mean / kBatch;
    squares += mean * mean / kBatch;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}
}  // namespace

Estimate estimate(const std::shared_ptr<const Scene>& scene, const Vec3d& from, const Vec3d& toward,
                  int max_depth, const char* technique) {
  RenderRequest request;
  request.technique = technique;
  request.max_depth = max_depth;
  return estimate(scene, from, toward, request, 1);
}
Estimate estimate(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                  const char* technique) {
  return estimate(load(scene), from, toward, max_depth, technique);
}
Estimate estimate_alone(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                        int samples) {
  RenderRequest request;
  request.technique = "path";
  request.max_depth = max_depth;
  request.reuse = 1;
  return estimate(load(scene), from, toward, request, samples);
}

std::vector<Vec3d> trace_picture(const Json& scene, const RenderRequest& request) {
  Tracing tracing(scene, request);
  const Plan plan = make_plan(*tracing.world().geometry->scene, request);
  const auto batch = std::make_unique<RayBatch<double>>();
  const TileSamples centres = TileSamples::centres();
  std::vector<Vec3d> pixels(static_cast<std::size_t>(plan.width * plan.height));
  const TileGrid grid(plan.width, plan.height);
  for (int number = 0; number < grid.size(); ++number) {
    const TileView tile = grid.at(number, 1);
    plan.camera->generate(plan.frame, plan.width, plan.height, tile, centres, *batch);
    std::vector<Ray<double>> rays;
    std::vector<std::size_t> places;
    for (int slot = 0; slot < kBatch; ++slot) {
      if (batch->t_max[slot] < 0) continue;
      const TilePixel p = tile_pixel(slot);
      places.push_back(static_cast<std::size_t>((tile.y0 + p.y) * plan.width + tile.x0 + p.x));
      rays.push_back({batch->origin[slot], batch->direction[slot]});
    }
    const std::vector<TraceOutput> answers = tracing.trace(rays);
    for (std::size_t i = 0; i < places.size(); ++i) pixels[places[i]] = answers[i].radiance;
  }
  return pixels;
}

}  // namespace orrery::test
