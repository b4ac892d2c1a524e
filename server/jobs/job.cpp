#include "server/jobs/job.h"

#include <algorithm>

#include "core/plan/cost.h"
#include "core/plan/options.h"
#include "core/plan/plan.h"
#include "server/rendering/pipeline.h"
#include "server/scheduler/watch.h"

namespace orrery {
namespace {

constexpr int kMaxPlanned = 1000;  // maximum steps in a cost estimate; longer jobs are sampled evenly

}  // namespace

Job::Job(std::string id, JobSpec spec, const RenderServices& services, std::chrono::seconds limit, Room room)
    : id_(std::move(id)),
      spec_(std::move(spec)),
      services_(services),
      limit_(limit),
      room_(std::move(room)),
      memory_(services.memory.open(spec_.client)),
      steps_(work().steps()),
      thread_([this] { run(); }) {}

Job::~Job() {
  cancel();
  release();
}

void Job::release() {
  if (thread_.joinable()) thread_.join();
}

void Job::cancel() { cancelled_.request_stop(); }

void Job::run() {
  const WorkCancellation watch(cancelled_.get_token(), services_.draining, services_.timer,
                               services_.timer.now(), {limit_, "job_seconds"});
  int next = 0;
  const Pipeline pipeline{
      .pool = services_.pool,
      .background = true,
      .next = [&]() -> std::optional<std::int64_t> {
        if (watch.stop().stop_requested()) throw Cancelled();
        if (next == work().steps()) return std::nullopt;
        return next++;
      },
      .render = [&](std::int64_t number) { return render(static_cast<int>(number), watch.stop()); },
      .encode = [this](const Film& film) { return work().encode(film); },
      .stop = watch.stop(),
      .memory = memory_.get(),
      .deliver = [this](std::int64_t number,
                        Frame&& frame) { keep(static_cast<int>(number), std::move(frame)); }};
  std::exception_ptr error;
  try {
    watch.run([&](const std::stop_token&) { pipeline.run(); });
  } catch (...) {
    error = std::current_exception();
  }
  end(error);
}

RenderResult Job::render(int step, const std::stop_token& stop) {
  const RenderOrder order =
      make_order(spec_.scene, work().request(step), work().format(), {spec_.client, stop});
  const Scene& scene = order.scene->scene();
  const std::int64_t tiles = TileGrid(order.plan.width, order.plan.height).size();
  // Assumes that all steps take as long as the step with the budget.
  RenderControl control{.stop = stop,
                        .max_s = kShareOfBudgets * static_cast<double>(limit_.count()) / work().steps()};
  const bool has_passes = has_budget(order.plan.asked);  // their number is not known in advance
  if (!has_passes)
    control.progress = [this, step, rays = expected_rays(scene, order.plan)](int done, int) {
      count(step, done, rays);
    };
  RenderResult rendered = services_.render_next(order, *memory_, true, control, [&] { begin(tiles); });
  if (has_passes) {  // counts the rays of the chosen settings, not of the search
    RenderRequest made;
    static_cast<RenderSettings&>(made) = rendered.budget->settings;
    count(step, tiles, expected_rays(scene, make_plan(scene, made)));
  }
  take(step, rendered);
  return rendered;
}

void Job::begin(std::int64_t tiles) {
  const std::lock_guard lock(mutex_);
  if (!started_) started_ = services_.timer.now();
  if (rays_ == 0) rays_ = rays_of_all();
  tiles_a_step_ = tiles;
  state_ = JobState::running;
}

void Job::take(int step, const RenderResult& rendered) {
  spec_.work->add(rendered);
  const int steps = work().steps();
  const bool changed = steps < steps_ || rendered.budget;  // a budget fixes the settings of later steps
  const double rays = step + 1 < steps && changed ? rays_of_all() : rays_;
  const std::lock_guard lock(mutex_);
  steps_ = steps;
  rays_ = rays;
}

double Job::rays_of_all() const {
  const Scene& scene = spec_.scene->scene();
  const int steps = work().steps(), planned = std::min(steps, kMaxPlanned);
  double sum = 0;
  for (std::int64_t i = 0; i < planned; ++i)
    sum += expected_rays(scene, make_plan(scene, work().request(static_cast<int>(i * steps / planned))));
  return sum * steps / planned;
}

void Job::count(int step, std::int64_t done, double rays) {
  const std::lock_guard lock(mutex_);
  const std::int64_t tiles = step * tiles_a_step_ + done;
  if (tiles <= tiles_done_) return;  // already counted in an attempt that ran out of memory
  rays_done_ += rays * static_cast<double>(tiles - tiles_done_) / static_cast<double>(tiles_a_step_);
  tiles_done_ = tiles;
  changed_.notify_all();
}

void Job::keep(int step, Frame&& frame) {
  const std::size_t bytes = frame.bytes.size();
  if (bytes > 0) room_(bytes);
  spec_.work->keep(step, std::move(frame.bytes));
  const std::lock_guard lock(mutex_);
  ++steps_done_;
  changed_.notify_all();
}

void Job::end(std::exception_ptr error) {
  spec_.work->end();
  memory_.reset();
  const std::lock_guard lock(mutex_);
  error_ = error;
  state_ = !error ? JobState::done : cancelled_.stop_requested() ? JobState::cancelled : JobState::failed;
  ended_ = services_.timer.now();
  ServiceCounters& meters = services_.meters;
  ++(state_ == JobState::done        ? meters.jobs_done
     : state_ == JobState::cancelled ? meters.jobs_cancelled
                                     : meters.jobs_failed);
  spec_.scene.reset();
  changed_.notify_all();
}

JobStatus Job::status() const {
  const std::lock_guard lock(mutex_);
  return status_locked();
}

std::optional<Clock::time_point> Job::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

JobStatus Job::wait(int steps, std::optional<std::int64_t> tiles, Clock::time_point until,
                    const std::stop_token& stop) const {
  std::unique_lock lock(mutex_);
  wait_until(services_.timer, changed_, lock, stop, until,
             [&] { return has_ended(state_) || steps_done_ > steps || (tiles && tiles_done_ != *tiles); });
  return status_locked();
}

JobStatus Job::status_locked() const {
  JobStatus status{.state = state_,
                   .steps = steps_,
                   .steps_done = steps_done_,
                   .tiles = steps_ * tiles_a_step_,
                   .tiles_done = tiles_done_,
                   .elapsed_s = 0,
                   .remaining_s = {},
                   .error = state_ == JobState::failed ? error_ : nullptr};
  if (!started_) return status;
  const auto until = ended_.value_or(services_.timer.now());
  status.elapsed_s = std::chrono::duration<double>(until - *started_).count();
  if (state_ == JobState::running && rays_done_ > 0)
    status.remaining_s = status.elapsed_s * std::max(0.0, rays_ / rays_done_ - 1);
  return status;
}

}  // namespace orrery
