#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "server/app/job.h"

namespace orrery {

// The jobs under way and those that ended lately. Safe from any thread.
class Jobs {
 public:
  struct Limits {
    int under_way;                  // at once (jobs); half of them for one client
    int ended;                      // that are kept (jobs_kept)
    std::size_t bytes;              // of the pictures of all (job_bytes)
    std::chrono::seconds run_time;  // of one (job_seconds)
    std::chrono::seconds kept;      // after its end (job_kept_seconds)
  };
  Jobs(const RenderServices& services, const Limits& limits) : services_(services), limits_(limits) {}
  ~Jobs();
  Jobs(const Jobs&) = delete;

  using JobPtr = std::shared_ptr<Job>;

  struct Started {
    JobPtr job;
    bool known;  // the client has started it before, by the same key
  };
  // Starts a job. With a `key` (not empty), a job that the same client started by it is returned instead, if
  // `content` is the same, or else InputError thrown. Throws Busy if too many are under way, ClientBusy if
  // too many of them are this client's.
  Started start(JobSpec spec, const std::string& key, const std::string& content);
  // Throws NotFound.
  JobPtr find(const std::string& id);
  // Cancels and forgets it. Throws NotFound.
  void remove(const std::string& id);

  std::size_t under_way();
  std::size_t bytes();

 private:
  struct Entry {
    JobPtr job;
    std::string key, content;
  };
  void make_room(std::size_t bytes);  // throws InputError
  // Below: with mutex_ held.
  void require_place(const std::string& client) const;
  void forget_old();
  std::size_t bytes_kept() const;

  const RenderServices services_;
  const Limits limits_;
  std::mutex mutex_;
  std::vector<Entry> entries_;  // the oldest first; guarded by mutex_
};

}  // namespace orrery
