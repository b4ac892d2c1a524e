#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "server/app/fair_shares.h"
#include "server/app/job.h"

namespace orrery {

// Running jobs and recently ended ones. FairShares evicts jobs if there are too many or their files take too
// many bytes. Ended jobs go first. Running jobs go last, and only those of a client that holds more than the
// one that needs room. Safe from any thread.
class Jobs {
 public:
  struct Limits {
    int under_way;                  // running at once (jobs); half of them for one client
    int ended;                      // ended jobs kept (jobs_kept)
    std::size_t bytes;              // images of all jobs (job_bytes)
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
  // throws InputError if `content` differs. Throws LimitExceeded if too many jobs are running,
  // ClientLimitExceeded if too many of them are this client's.
  StartResult start(JobSpec spec, const std::string& key, const std::string& content);
  // Throws NotFound.
  JobPtr find(const std::string& id);
  // Cancels and removes the job. Throws NotFound.
  void remove(const std::string& id);

  std::size_t under_way();
  std::size_t bytes();
  std::uint64_t evictions() const { return evictions_; }  // since the start

 private:
  struct Entry {
    JobPtr job;
    std::string key, content;
    bool evicted = false;  // removed once it ends
  };
  // Makes room for more bytes of the job. Throws InputError if there is none, Cancelled if the job was
  // evicted.
  void make_room(const std::string& id, const std::string& client, std::size_t bytes);
  // REQUIRES for the functions below: mutex_ is held.
  void require_place(const std::string& client) const;
  void forget_old();
  void forget(const std::vector<std::string>& ids);  // cancels running jobs
  bool is_kept(const std::string& id) const { return bytes_.rank(id).has_value(); }

  const RenderServices services_;
  const Limits limits_;
  std::mutex mutex_;
  std::vector<Entry> entries_;  // oldest first; guarded by mutex_
  std::atomic<std::uint64_t> evictions_{0};
  // Guarded by mutex_: bytes of all jobs, and number of ended jobs. Entries never expire here, because
  // forget_old() removes old jobs.
  FairShares bytes_{Clock::duration::max()}, ended_{Clock::duration::max()};
};

}  // namespace orrery
