#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "server/base/fair_shares.h"
#include "server/jobs/job.h"

namespace orrery {

// Running jobs and recently ended jobs. If there are too many jobs or bytes, FairShares selects jobs to
// evict. Ended jobs are evicted first. A running job is evicted only for a client that holds fewer bytes than
// the client of the job. Thread-safe.
class Jobs {
 public:
  struct Limits {
    int under_way;                  // maximum unfinished jobs (jobs); one client: half
    int ended;                      // maximum ended jobs (max_finished_jobs)
    std::size_t bytes;              // maximum image bytes of all jobs (job_bytes)
    std::chrono::seconds run_time;  // per job (job_seconds)
    std::chrono::seconds kept;      // after the job's end (job_kept_seconds)
  };
  Jobs(const RenderServices& services, const Limits& limits) : services_(services), limits_(limits) {}
  ~Jobs();
  Jobs(const Jobs&) = delete;

  using JobPtr = std::shared_ptr<Job>;

  struct StartResult {
    JobPtr job;
    bool known;  // already started by the client with the same key
  };
  // Starts a job. If `key` is not empty and the client already started a job with it, returns that job, or
  // throws InputError if `content` differs. Throws LimitExceeded if too many jobs are unfinished, or
  // ClientLimitExceeded if too many of these belong to the client.
  StartResult start(JobSpec spec, const std::string& key, const std::string& content);
  // Throws NotFound if the job is unknown, expired or evicted.
  JobPtr find(const std::string& id);
  // Cancels and removes the job. Throws the errors of find().
  void remove(const std::string& id);

  std::size_t under_way();  // unfinished jobs
  std::size_t bytes();
  std::uint64_t evictions() const { return evictions_; }  // since the start

 private:
  struct Entry {
    JobPtr job;
    std::string key, content;
    bool evicted = false;  // removed once it ends
  };
  // Reserves `bytes` more for the job, and evicts other jobs if necessary. Throws InputError if they do not
  // fit, or Cancelled if the job was evicted.
  void make_room(const std::string& id, const std::string& client, std::size_t bytes);
  // REQUIRES for the functions below: mutex_ is held.
  void require_place(const std::string& client) const;
  void forget_old();
  void forget(const std::vector<std::string>& ids);  // cancels running jobs

  const RenderServices services_;
  const Limits limits_;
  std::mutex mutex_;
  std::vector<Entry> entries_;  // oldest first; guarded by mutex_
  std::atomic<std::uint64_t> evictions_{0};
  // Guarded by mutex_: bytes of all jobs, and number of ended jobs. Entries of FairShares never expire,
  // because forget_old() removes old jobs.
  FairShares bytes_{Clock::duration::max()}, ended_{Clock::duration::max()};
};

}  // namespace orrery
