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

#include "server/jobs/job_work.h"
#include "server/rendering/frame.h"
#include "server/rendering/render_services.h"

namespace orrery {

// Work of a job and its client.
struct JobSpec {
  std::shared_ptr<const StoredScene> scene;
  std::unique_ptr<JobWork> work;
  std::string client;
};

enum class JobState { waiting, running, done, failed, cancelled };
inline constexpr std::string_view name_of(JobState state) {
  constexpr std::array<std::string_view, 5> kNames{"waiting", "running", "done", "failed", "cancelled"};
  return kNames[static_cast<std::size_t>(state)];
}
inline constexpr bool has_ended(JobState state) { return state >= JobState::done; }

// Progress of a job.
struct JobStatus {
  JobState state = JobState::waiting;
  int steps = 1, steps_done = 0;           // images
  std::int64_t tiles = 0, tiles_done = 0;  // in all steps; `tiles` is 0 before the first step starts
  double elapsed_s = 0;                    // since the job got its first slot
  std::optional<double> remaining_s;       // at the measured rate; nullopt if unknown
  std::exception_ptr error;                // reason of a failure, or null
};

// Long render on its own thread. Each step waits for a slot with batch priority. After its end, the job keeps
// its results but releases its scene. Thread-safe.
class Job {
 public:
  // Called with the size of each result before it is stored. Throws if the result cannot be stored.
  using Room = std::function<void(std::size_t bytes)>;

  // The objects in `services` must outlive the job. The job fails with TimedOut after `limit`.
  Job(std::string id, JobSpec spec, const RenderServices& services, std::chrono::seconds limit, Room room);
  ~Job();  // cancels the job and joins its thread
  Job(const Job&) = delete;

  const std::string& id() const { return id_; }
  const std::string& client() const { return spec_.client; }
  const JobWork& work() const { return *spec_.work; }
  JobStatus status() const;
  std::optional<Clock::time_point> ended() const;

  // Waits until more than `steps` steps are done, the job has ended, `until` has passed or `stop` is
  // requested. If `tiles` is set, also stops waiting once the number of finished tiles differs from it.
  JobStatus wait(int steps, std::optional<std::int64_t> tiles, Clock::time_point until,
                 const std::stop_token& stop) const;

  void cancel();
  // Joins the thread. Must not be called concurrently. REQUIRES: the job has ended.
  void release();

 private:
  void run();
  RenderResult render(int step, const std::stop_token& stop);
  void begin(std::int64_t tiles);  // records that a step of `tiles` tiles has its slot
  void take(int step, const RenderResult& rendered);
  double rays_of_all() const;  // estimated rays of all steps, from their plans
  // Records that `done` tiles of a step are finished. `rays`: estimated cost of the whole step.
  void count(int step, std::int64_t done, double rays);
  void keep(int step, Frame&& frame);
  void end(std::exception_ptr error);
  JobStatus status_locked() const;

  const std::string id_;
  JobSpec spec_;
  const RenderServices services_;
  const std::chrono::seconds limit_;
  const Room room_;
  std::shared_ptr<WorkAccount> memory_;  // account of the films; reset at the end
  std::stop_source cancelled_;
  mutable std::mutex mutex_;  // guards the members below
  mutable std::condition_variable_any changed_;
  int steps_, steps_done_ = 0;
  JobState state_ = JobState::waiting;
  std::exception_ptr error_;
  std::int64_t tiles_a_step_ = 0, tiles_done_ = 0;
  double rays_done_ = 0, rays_ = 0;  // see rays_of_all()
  std::optional<Clock::time_point> started_, ended_;
  std::thread thread_;  // last: uses the members above
};

}  // namespace orrery
