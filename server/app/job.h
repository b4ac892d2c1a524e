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
#include <vector>

#include "core/study/study.h"
#include "server/app/orbit.h"
#include "server/app/render_services.h"
#include "server/app/watch.h"

namespace orrery {

// Long work: a picture, the frames of an orbit, or the pictures that make a chart, which are not kept.
struct JobSpec {
  std::shared_ptr<const PreparedScene> scene;
  OrbitPath path;                // of the frames,
  std::shared_ptr<Study> study;  // unless there is this
  int frames = 1;
  std::string client;  // who asked for it
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
  int frames = 1, frames_done = 0;
  std::int64_t tiles = 0, tiles_done = 0;  // of all frames; `tiles` is 0 before the first frame began
  double elapsed_s = 0;                    // since its first turn
  std::optional<double> remaining_s;       // at the rate so far; none before anything is known
  std::exception_ptr error;                // why it failed
};

// Renders on a thread of its own, frame by frame in the batch lane's turn, and keeps the pictures, but not
// the scene once it has ended. Safe from any thread.
class Job {
 public:
  // `room`: called with the bytes of each picture before it is kept; throws if there is no room for them.
  using Room = std::function<void(std::size_t bytes)>;
  using Picture = std::shared_ptr<const std::string>;  // a PNG file

  // What `services` refers to must outlive it. It ends as TimedOut after `limit`.
  Job(std::string id, JobSpec spec, const RenderServices& services, std::chrono::seconds limit, Room room);
  ~Job();  // cancels it
  Job(const Job&) = delete;

  const std::string& id() const { return id_; }
  const std::string& client() const { return spec_.client; }
  int frames() const { return spec_.frames; }
  JobStatus status() const;
  std::optional<Clock::time_point> ended() const;
  std::size_t bytes() const;  // of the pictures

  // Frame 0, 1, ...; null as long as it is not rendered. REQUIRES: frame < frames(), no study().
  Picture frame(int number) const;

  // What the job measures; null if it does not. REQUIRES, to look at its chart: the job is done.
  std::shared_ptr<const Study> study() const { return spec_.study; }

  // Waits until more than `frames` are done, the job has ended, `until` has come or `stop` is requested; if
  // `tiles` is given, also until another number of tiles is done.
  JobStatus wait(int frames, std::optional<std::int64_t> tiles, Clock::time_point until,
                 const std::stop_token& stop) const;

  void cancel();
  // Gives its thread back. REQUIRES: it has ended; one caller at a time.
  void release();

 private:
  void run();
  RenderRequest request(int number) const;
  double whole_cost() const;  // of all frames, in rays by estimate
  RenderResult render(int number, const Watch& watch);
  void keep(Frame&& frame);
  void end(std::exception_ptr error);
  JobStatus status_locked() const;

  const std::string id_;
  JobSpec spec_;
  const RenderServices services_;
  const std::chrono::seconds limit_;
  const Room room_;
  std::stop_source cancelled_;
  mutable std::mutex mutex_;  // guards all below
  mutable std::condition_variable_any changed_;
  std::vector<Picture> pictures_;
  std::size_t bytes_ = 0;
  JobState state_ = JobState::waiting;
  std::exception_ptr error_;
  std::int64_t tiles_a_frame_ = 0, tiles_done_ = 0;
  double cost_done_ = 0, cost_ = 0;
  std::optional<Clock::time_point> started_, ended_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace orrery
