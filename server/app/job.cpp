#include "server/app/job.h"

#include <algorithm>

#include "core/plan/plan.h"
#include "server/app/pipeline.h"

namespace orrery {

Job::Job(std::string id, JobSpec spec, const RenderServices& services, std::chrono::seconds limit, Room room)
    : id_(std::move(id)),
      spec_(std::move(spec)),
      services_(services),
      limit_(limit),
      room_(std::move(room)),
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
  const Watch watch(cancelled_.get_token(), services_.draining, services_.timer, services_.timer.now(),
                    {limit_, "job_seconds"});
  int next = 0;
  const Pipeline pipeline{
      .pool = services_.pool,
      .background = true,
      .next = [&]() -> std::optional<std::int64_t> {
        if (watch.stop().stop_requested()) throw Cancelled();
        if (next == spec_.frames) return std::nullopt;
        return next++;
      },
      .render = [&](std::int64_t number) { return render(static_cast<int>(number), watch); },
      .encode = [this](const Film& film) { return spec_.study ? "" : encode_film(film, FileFormat::png); },
      .deliver = [this](std::int64_t, Frame&& frame) { keep(std::move(frame)); }};
  std::exception_ptr error;
  try {
    try {
      pipeline.run();
    } catch (const Cancelled&) {
      watch.explain();
    }
  } catch (...) {
    error = std::current_exception();
  }
  end(error);
}

RenderRequest Job::request(int number) const {
  return spec_.study ? spec_.study->request(number) : spec_.path.at(number);
}

double Job::whole_cost() const {
  const auto cost = [&](int number) { return cost_of(make_plan(spec_.scene->scene(), request(number))); };
  if (!spec_.study) return spec_.frames * cost(0);
  double sum = 0;
  for (int number = 0; number < spec_.frames; ++number) sum += cost(number);
  return sum;
}

RenderResult Job::render(int number, const Watch& watch) {
  const Plan plan = make_plan(spec_.scene->scene(), request(number));
  const double cost = cost_of(plan);
  const auto ticket = services_.admission.enter_again({Lane::batch, spec_.client, cost}, watch.stop());
  {
    const std::lock_guard lock(mutex_);
    if (!started_) started_ = services_.timer.now();
    if (cost_ == 0) cost_ = whole_cost();
    state_ = JobState::running;
  }
  const auto progress = [this, cost](int, int total) {
    const std::lock_guard lock(mutex_);
    tiles_a_frame_ = total;
    ++tiles_done_;
    cost_done_ += cost / total;
    changed_.notify_all();
  };
  Study* study = spec_.study.get();
  RenderResult rendered = services_.render(*spec_.scene, settle(*spec_.scene, plan, watch.stop()),
                                           study ? FilmStorage::linear32 : FilmStorage::srgb8,
                                           {.stop = watch.stop(), .progress = progress, .background = true});
  if (study) study->add(rendered);
  return rendered;
}

void Job::keep(Frame&& frame) {
  if (!spec_.study) room_(frame.bytes.size());
  const std::lock_guard lock(mutex_);
  bytes_ += frame.bytes.size();
  pictures_.push_back(std::make_shared<const std::string>(std::move(frame.bytes)));
  changed_.notify_all();
}

void Job::end(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  error_ = error;
  state_ = !error ? JobState::done : cancelled_.stop_requested() ? JobState::cancelled : JobState::failed;
  ended_ = services_.timer.now();
  Meters& meters = services_.meters;
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

std::size_t Job::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

Job::Picture Job::frame(int number) const {
  const std::lock_guard lock(mutex_);
  const auto index = static_cast<std::size_t>(number);
  return index < pictures_.size() ? pictures_[index] : nullptr;
}

JobStatus Job::wait(int frames, std::optional<std::int64_t> tiles, Clock::time_point until,
                    const std::stop_token& stop) const {
  std::unique_lock lock(mutex_);
  wait_until(services_.timer, changed_, lock, stop, until, [&] {
    return has_ended(state_) || pictures_.size() > static_cast<std::size_t>(frames) ||
           (tiles && tiles_done_ != *tiles);
  });
  return status_locked();
}

JobStatus Job::status_locked() const {
  JobStatus status{.state = state_,
                   .frames = spec_.frames,
                   .frames_done = static_cast<int>(pictures_.size()),
                   .tiles = spec_.frames * tiles_a_frame_,
                   .tiles_done = tiles_done_,
                   .elapsed_s = 0,
                   .remaining_s = {},
                   .error = state_ == JobState::failed ? error_ : nullptr};
  if (!started_) return status;
  const auto until = ended_.value_or(services_.timer.now());
  status.elapsed_s = std::chrono::duration<double>(until - *started_).count();
  if (state_ == JobState::running && cost_done_ > 0)
    status.remaining_s = status.elapsed_s * std::max(0.0, cost_ / cost_done_ - 1);
  return status;
}

}  // namespace orrery
