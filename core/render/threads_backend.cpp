#include <atomic>
#include <numeric>
#include <vector>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/prepare/geometry.h"
#include "core/prepare/staged_world.h"
#include "core/render/backend.h"
#include "core/render/tile_renderer.h"

namespace orrery {
namespace {

template <class T>
class OnThreads final : public Prepared {
 public:
  OnThreads(World<T> world, SettledPlan plan, Executor& executor)
      : world_(std::move(world)), plan_(std::move(plan)), executor_(executor) {}

  void render(std::span<const TileView> tiles, Film& film, RenderStats& stats,
              const RenderControl& control) override {
    std::vector<std::unique_ptr<TileRenderer<T>>> renderers(static_cast<std::size_t>(executor_.threads()));
    std::vector<double> cpu_ms(renderers.size());
    std::atomic<int> done = 0;
    const int total = static_cast<int>(tiles.size());
    const auto start = Clock::now();
    executor_.for_each(total, [&](int step, int worker) {
      const TaskContext task = TaskScope::current();
      const TaskScope scope({task.memory, &control.stop, task.time_slice});
      checkpoint();
      const double cpu_before = thread_cpu_ms();
      auto& renderer = renderers[static_cast<std::size_t>(worker)];
      if (!renderer) renderer = std::make_unique<TileRenderer<T>>(world_, *plan_);
      renderer->render(tiles[static_cast<std::size_t>(step)], film);
      cpu_ms[static_cast<std::size_t>(worker)] += thread_cpu_ms() - cpu_before;
      ++done;
      if (control.progress) control.progress(done, total);
    });
    for (const auto& renderer : renderers)
      if (renderer) renderer->add_to(stats);
    stats.trace_ms += milliseconds_since(start);
    stats.cpu_ms += std::accumulate(cpu_ms.begin(), cpu_ms.end(), 0.0);
  }

 private:
  const World<T> world_;
  const SettledPlan plan_;
  Executor& executor_;
};

class ThreadsBackend final : public Backend {
 public:
  explicit ThreadsBackend(Executor& executor) : executor_(executor) {}

  std::unique_ptr<Prepared> prepare(const PreparedScene& scene, const SettledPlan& plan, RenderStats& stats,
                                    std::stop_token stop) override {
    return plan->double_precision ? prepare_in<double>(scene, plan, stats, stop)
                                  : prepare_in<float>(scene, plan, stats, stop);
  }

 private:
  template <class T>
  std::unique_ptr<Prepared> prepare_in(const PreparedScene& scene, const SettledPlan& plan,
                                       RenderStats& stats, std::stop_token stop) {
    World<T> world = staged_world<T>(scene.parts(), plan, stats.build_ms, stop);
    stats.accelerator = plan->accelerator;
    stats.structure = facts_of(world);
    return std::make_unique<OnThreads<T>>(std::move(world), plan, executor_);
  }

  Executor& executor_;
};

}  // namespace

std::unique_ptr<Backend> threads_backend(Executor& executor) {
  return std::make_unique<ThreadsBackend>(executor);
}

}  // namespace orrery
