#include "server/jobs/jobs.h"

#include <algorithm>

#include "core/base/shorten.h"
#include "server/base/request_id.h"

namespace orrery {
namespace {

constexpr FairShares::Rank kEnded = 0, kUnderWay = 1;

}  // namespace

Jobs::~Jobs() {
  std::vector<Entry> entries;
  const std::lock_guard lock(mutex_);
  entries.swap(entries_);  // destroyed without the lock: ending jobs call make_room()
}

Jobs::StartResult Jobs::start(JobSpec spec, const std::string& key, const std::string& content) {
  const std::lock_guard lock(mutex_);
  forget_old();
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return !key.empty() && e.key == key && e.job->client() == spec.client && !e.evicted;
  });
  if (known != entries_.end()) {
    if (known->content == content) return {known->job, true};
    throw InputError("", "Idempotency-Key " + key.substr(0, 80) + " is in use for another job");
  }
  require_place(spec.client);
  constexpr std::size_t kIdBytes = 16;  // ids cannot be guessed
  const std::string id = random_hex(kIdBytes), client = spec.client;
  auto job = std::make_shared<Job>(id, std::move(spec), services_, limits_.run_time,
                                   [this, id, client](std::size_t bytes) { make_room(id, client, bytes); });
  entries_.push_back({job, key, content});
  bytes_.hold(id, client, kUnderWay);
  return {job, false};
}

void Jobs::require_place(const std::string& client) const {
  int under_way = 0, own = 0;
  for (const Entry& entry : entries_) {
    if (entry.job->ended()) continue;
    ++under_way;
    own += entry.job->client() == client;
  }
  Quota{.noun = "job", .state = "running", .limit = "jobs", .most = limits_.under_way, .retry_s = 10}
      .require_one_more(under_way, own);
}

Jobs::JobPtr Jobs::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  forget_old();
  bytes_.touch(id);
  ended_.touch(id);
  for (const Entry& entry : entries_)
    if (entry.job->id() == id && !entry.evicted) return entry.job;
  throw NotFound("unknown job " + id.substr(0, 64) + " (it may have expired)");
}

void Jobs::remove(const std::string& id) {
  const JobPtr job = find(id);
  job->cancel();
  const std::lock_guard lock(mutex_);
  bytes_.erase(id);
  ended_.erase(id);
  std::erase_if(entries_, [&](const Entry& entry) { return entry.job == job; });
}

std::size_t Jobs::under_way() {
  const std::lock_guard lock(mutex_);
  forget_old();
  return static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.job->ended(); }));
}

std::size_t Jobs::bytes() {
  const std::lock_guard lock(mutex_);
  return bytes_.weight();
}

void Jobs::forget_old() {
  const auto now = services_.timer.now();
  std::vector<std::string> old;
  for (const Entry& entry : entries_) {
    const auto ended = entry.job->ended();
    if (!ended) continue;
    entry.job->release();
    const std::string& id = entry.job->id();
    if (entry.evicted || now - *ended > limits_.kept) {
      old.push_back(id);
    } else if (bytes_.rank(id) == kUnderWay) {
      bytes_.hold(id, entry.job->client(), kEnded);
      ended_.hold(id, entry.job->client());
      ended_.set_weight(id, 1);
    }
  }
  forget(old);
  if (const auto surplus = ended_.make_room("", 0, static_cast<std::size_t>(limits_.ended), {})) {
    evictions_ += surplus->size();
    forget(*surplus);
  }
}

// Cancels the running jobs. They stay in entries_ until they have ended.
void Jobs::forget(const std::vector<std::string>& ids) {
  for (const std::string& id : ids) {
    bytes_.erase(id);
    ended_.erase(id);
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.job->id() == id; });
    if (entry == entries_.end()) continue;
    entry->job->cancel();
    entry->evicted = true;
    if (entry->job->ended()) entries_.erase(entry);
  }
}

void Jobs::make_room(const std::string& id, const std::string& client, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  forget_old();
  if (!bytes_.holds(id, client)) throw Cancelled();
  const auto evicted = bytes_.make_room(client, bytes, limits_.bytes, {.own = kUnderWay});
  if (!evicted)
    throw InputError(
        "", "images of all jobs take too many bytes (limit " + grouped(limits_.bytes) + ", job_bytes)");
  evictions_ += evicted->size();
  forget(*evicted);
  bytes_.set_weight(id, bytes_.weight(id) + bytes);
}

}  // namespace orrery
