#pragma once

#include <array>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "server/app/frame.h"
#include "server/app/job_work.h"
#include "server/app/render_services.h"
#include "server/app/watch.h"

namespace orrery {

// Long work, and who asked for it.
struct JobSpec {
  std::shared_ptr<const PreparedScene> scene;
  std::unique_ptr<JobWork> work;
  std::string client;
};

enum class JobState { waiting, running, done, failed, cancelled };
inline constexpr std::string_view name_of(JobState state) {
  constexpr std::array<std::string_view, 5> kNames{"waiting", "running", "done", "failed", "cancelled"};
  return kNames[static_cast<std::size_t>(state)];
}
inline constexpr bool has_ended(JobState state) { return state >= JobState::done; }

// How far a job is.
struct JobStatus {
  JobState state = JobState::waiting;
  int steps = 1, steps_done = 0;           // pictures
  std::int64_t tiles = 0, tiles_done = 0;  // of all steps; `tiles` is 0 before the first one began
  double elapsed_s = 0;                    // since its first turn
  std::optional<double> remaining_s;       // at the rate so far; none before anything is known
  std::exception_ptr error;                // why it failed
};

// Does its work on a thread of its own, step by step in the batch lane's turn; keeps what it made, but not
// the scene once it has ended. Safe from any thread.
class Job {
 public:
  // `room`: called with the bytes of each step before they are kept; throws if there is no room for them.
  using Room = std::function<void(std::size_t bytes)>;

  // What `services` refers to must outlive it. It ends as TimedOut after `limit`.
  Job(std::string id, JobSpec spec, const RenderServices& services, std::chrono::seconds limit, Room room);
  ~Job();  // cancels it
  Job(const Job&) = delete;

  const std::string& id() const { return id_; }
  const std::string& client() const { return spec_.client; }
  const JobWork& work() const { return *spec_.work; }
  JobStatus status() const;
  std::optional<Clock::time_point> ended() const;

  // Waits until more than `steps` are done, the job has ended, `until` has come or `stop` is requested; if
  // `tiles` is given, also until another number of tiles is done.
  JobStatus wait(int steps, std::optional<std::int64_t> tiles, Clock::time_point until,
                 const std::stop_token& stop) const;

  void cancel();
  // Gives its thread back. REQUIRES: it has ended; one caller at a time.
  void release();

 private:
  void run();
  Plan plan(int step) const;
  void take(int step, const RenderResult& rendered);
  double rays_of_all() const;  // expected of all steps, by their plans alone: their proportions stay
  RenderResult render(int step, const Watch& watch);
  RenderResult try_render(int step, const Watch& watch);  // throws OverLimit where memory is short now
  // So many tiles of a step, which takes so many rays in all, are done.
  void count(int step, std::int64_t done, double rays);
  void keep(int step, Frame&& frame);
  void end(std::exception_ptr error);
  JobStatus status_locked() const;

  const std::string id_;
  JobSpec spec_;
  const RenderServices services_;
  const std::chrono::seconds limit_;
  const Room room_;
  std::shared_ptr<MemoryAccount> memory_;  // of films; for its thread, which gives it back at the end
  std::stop_source cancelled_;
  mutable std::mutex mutex_;  // guards all below
  mutable std::condition_variable_any changed_;
  int steps_, steps_done_ = 0;
  JobState state_ = JobState::waiting;
  std::exception_ptr error_;
  std::int64_t tiles_a_step_ = 0, tiles_done_ = 0;
  double rays_done_ = 0, rays_ = 0;  // see rays_of_all()
  std::optional<Clock::time_point> started_, ended_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace orrery
