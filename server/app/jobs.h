#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "server/app/fair_shares.h"
#include "server/app/job.h"

namespace orrery {

// The jobs under way and those that ended lately. Where there are too many, or their files take too many
// bytes, FairShares says whose go: jobs that have ended, and last the job under way of a client that holds
// more than the one that needs room. Safe from any thread.
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
  std::uint64_t evictions() const { return evictions_; }  // since the start

 private:
  struct Entry {
    JobPtr job;
    std::string key, content;
    bool evicted = false;  // its end is waited for
  };
  // For more bytes of the job. Throws InputError, and Cancelled if the job was evicted.
  void make_room(const std::string& id, const std::string& client, std::size_t bytes);
  // Below: with mutex_ held.
  void require_place(const std::string& client) const;
  void forget_old();
  void forget(const std::vector<std::string>& ids);  // cancels those that have not ended
  bool is_kept(const std::string& id) const { return bytes_.rank(id).has_value(); }

  const RenderServices services_;
  const Limits limits_;
  std::mutex mutex_;
  std::vector<Entry> entries_;  // the oldest first; guarded by mutex_
  std::atomic<std::uint64_t> evictions_{0};
  // Guarded by mutex_: the bytes of all jobs, and the number of those that have ended. None of them is too
  // old: limits_.kept ends them.
  FairShares bytes_{Clock::duration::max()}, ended_{Clock::duration::max()};
};

}  // namespace orrery
