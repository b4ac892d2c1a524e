#include "server/app/jobs.h"

#include <algorithm>

#include "server/http/request_id.h"

namespace orrery {

Jobs::~Jobs() {
  std::vector<Entry> entries;
  const std::lock_guard lock(mutex_);
  entries.swap(entries_);  // jobs may still ask for room while they end
}

Jobs::Started Jobs::start(JobSpec spec, const std::string& key, const std::string& content) {
  const std::lock_guard lock(mutex_);
  forget_old();
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return !key.empty() && e.key == key && e.job->client() == spec.client;
  });
  if (known != entries_.end()) {
    if (known->content == content) return {known->job, true};
    throw InputError("", "another job was started by the Idempotency-Key " + key.substr(0, 80));
  }
  require_place(spec.client);
  constexpr std::size_t kIdBytes = 16;  // nobody can guess it
  auto job = std::make_shared<Job>(random_hex(kIdBytes), std::move(spec), services_, limits_.run_time,
                                   [this](std::size_t bytes) { make_room(bytes); });
  entries_.push_back({job, key, content});
  return {job, false};
}

void Jobs::require_place(const std::string& client) const {
  int under_way = 0, own = 0;
  for (const Entry& entry : entries_) {
    if (entry.job->ended()) continue;
    ++under_way;
    own += entry.job->client() == client;
  }
  Quota{.what = "jobs are under way", .limit = "jobs", .most = limits_.under_way, .retry_s = 10}
      .require_one_more(under_way, own);
}

Jobs::JobPtr Jobs::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  forget_old();
  for (const Entry& entry : entries_)
    if (entry.job->id() == id) return entry.job;
  throw NotFound("There is no job " + id.substr(0, 64) + " (any more)");
}

void Jobs::remove(const std::string& id) {
  const JobPtr job = find(id);
  job->cancel();
  const std::lock_guard lock(mutex_);
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
  return bytes_kept();
}

std::size_t Jobs::bytes_kept() const {
  std::size_t sum = 0;
  for (const Entry& entry : entries_) sum += entry.job->bytes();
  return sum;
}

void Jobs::forget_old() {
  const auto now = services_.timer.now();
  auto surplus = -static_cast<std::ptrdiff_t>(limits_.ended);
  for (const Entry& entry : entries_) {
    if (!entry.job->ended()) continue;
    entry.job->release();
    ++surplus;
  }
  std::erase_if(entries_, [&](const Entry& entry) {
    const auto ended = entry.job->ended();
    return ended && (surplus-- > 0 || now - *ended > limits_.kept);
  });
}

void Jobs::make_room(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  forget_old();
  while (bytes_kept() + bytes > limits_.bytes) {
    const auto oldest =
        std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.job->ended(); });
    if (oldest == entries_.end())
      throw InputError("", "the pictures of all jobs take more than " + std::to_string(limits_.bytes) +
                               " bytes (job_bytes)");
    entries_.erase(oldest);
  }
}

}  // namespace orrery
