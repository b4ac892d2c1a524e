#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/geometry.h"
#include "core/render/prepare.h"
#include "core/render/tile.h"

namespace orrery {

struct WorkerPool::Parts {
  explicit Parts(int threads)
      : allowed(
            tbb::global_control::max_allowed_parallelism,
            1 + static_cast<std::size_t>(threads > 0 ? threads : tbb::this_task_arena::max_concurrency())),
        arena(threads > 0 ? threads : tbb::task_arena::automatic, 0) {}
  tbb::global_control allowed;  // the caller and its workers, more than the cores if asked for
  tbb::task_arena arena;
};

WorkerPool::WorkerPool(int threads) : parts_(std::make_unique<Parts>(threads)) {}
WorkerPool::~WorkerPool() = default;
int WorkerPool::threads() const { return parts_->arena.max_concurrency(); }
void WorkerPool::enqueue(std::function<void()> task) {
  struct Job {
    Handover to_worker;
    std::function<void()> task;
    void run() {
      to_worker.take();
      const std::unique_ptr<Job> owned(this);
      task();
    }
  };
  Job* const job = new Job{{}, std::move(task)};
  job->to_worker.give();
  parts_->arena.enqueue([job]() ORRERY_UNSEEN { job->run(); });
}

namespace {

template <class T>
RenderResult render(const PreparedScene& scene, const Plan& plan, PixelFormat format, WorkerPool& pool,
                    const RenderControl& control) {
  RenderStats stats;
  const World<T> world = world_for<T>(scene.parts(), plan, stats.build_ms, control.stop);
  stats.accelerator = plan.accelerator;
  stats.structure = facts_of(world);
  Image image(plan.width, plan.height, format);
  tbb::enumerable_thread_specific<std::unique_ptr<TileRenderer<T>>> renderers(
      [&] { return std::make_unique<TileRenderer<T>>(world, plan); });
  const int across = (plan.width + kTileSide - 1) / kTileSide,
            down = (plan.height + kTileSide - 1) / kTileSide;
  std::atomic<int> done = 0;
  std::atomic<bool> stopped = false;
  const auto start = Clock::now();
  tbb::task_group_context context;
  Handover to_workers, from_workers;
  const auto render_tile = [&](int tile) {
    if (control.stop && control.stop()) {
      stopped = true;
      context.cancel_group_execution();
    }
    if (stopped) return;
    renderers.local()->render(tile % across * kTileSide, tile / across * kTileSide, control.stop, image);
    if (control.progress) control.progress(++done, across * down);
    from_workers.give();
  };
  const auto on_worker = [&](int tile) ORRERY_UNSEEN {
    to_workers.take();
    render_tile(tile);
  };
  to_workers.give();
  pool.parts().arena.execute([&]() ORRERY_UNSEEN {
    tbb::parallel_for(0, across * down, on_worker, tbb::auto_partitioner(), context);
  });
  from_workers.take();
  for (const auto& renderer : renderers) {
    stopped = stopped || renderer->stopped();
    renderer->add_to(stats);
  }
  if (stopped) throw Cancelled();
  stats.mean_cut /= static_cast<double>(plan.width) * plan.height;
  stats.trace_ms = milliseconds_since(start);
  return {std::move(image), stats};
}

}  // namespace

RenderResult render_frame(const PreparedScene& scene, const Plan& plan, PixelFormat format, WorkerPool& pool,
                          const RenderControl& control) {
  if (plan.try_accelerators) {
    Plan settled = plan;
    const double took_ms = settle(scene, settled, control.stop);
    RenderResult result = render_frame(scene, settled, format, pool, control);
    result.stats.build_ms += took_ms;
    return result;
  }
  return plan.double_precision ? render<double>(scene, plan, format, pool, control)
                               : render<float>(scene, plan, format, pool, control);
}

}  // namespace orrery
