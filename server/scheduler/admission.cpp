#include "server/scheduler/admission.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "core/base/shorten.h"
#include "server/scheduler/handler_slots.h"

namespace orrery {
namespace {

constexpr double kRaysAByte = 1;        // rays per byte of JSON or mesh data; measured: 0.5 to 2
constexpr double kExpectedRate = 10e6;  // rays per second over all slots
// Minimum time in a slot before work of another client, or of the same client, may preempt.
constexpr std::chrono::milliseconds kMinTimeSlice{50};
constexpr auto kOwnClientTimeSlice = 4 * kMinTimeSlice;
// Maximum debt of a client in units of kMinTimeSlice. It delays the client by seconds, not minutes.
constexpr double kMaxDebt = 16;
constexpr double kSmallCost = 2 * kFixedCost;
constexpr double kMemory_s = 10;  // busy seconds until a measurement has decayed to 1/e

// Returns the charge in rays for holding one of `places` slots for the time `held`. The rate is constant. The
// measured rate would charge too little after slow work, when the charge matters most.
double rays_in(std::chrono::duration<double> held, int places) {
  return held.count() * kExpectedRate / places;
}

std::string whole(double rays) {
  char text[32];
  if (rays < 1e15) return grouped(static_cast<std::uint64_t>(std::llround(std::max(rays, 0.0))));
  std::snprintf(text, sizeof text, "%.3g", rays);
  return text;
}

// Returns the client with the highest cost, and that cost. REQUIRES: `costs` is not empty.
std::pair<std::string, double> greediest(const std::map<std::string, double>& costs) {
  return *std::max_element(costs.begin(), costs.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
}

std::string in_millions(double rays) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g million", rays / 1e6);
  return text;
}

}  // namespace

TooManyRays::TooManyRays(double expected, double most)
    : InputError("", "image needs an estimated " + whole(expected) + " rays (limit " + whole(most) +
                         ", request_rays); start a job for longer work: POST /v1/jobs") {}

double cost_of_reading(std::size_t bytes) { return kFixedCost + kRaysAByte * static_cast<double>(bytes); }

void Quota::require_one_more(int all, int own) const {
  const auto items = [&](int count, const char* owner) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s") + owner +
           (count == 1 ? " is " : " are ") + state;
  };
  const int share = std::max(1, most / 2);
  if (all >= most)
    throw LimitExceeded(items(all, "") + " (limit " + std::to_string(most) + ", " + limit + ")", retry_s,
                        limit);
  if (own >= share)
    throw ClientLimitExceeded(
        items(own, " of this client") + " (limit " + std::to_string(share) + " per client, " + limit + ")",
        retry_s, limit);
}

int Admission::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}
int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::count_if(works_.begin(), works_.end(), [](const QueueEntry& w) {
    return w.state == State::waits || w.state == State::lost;
  }));
}
bool Admission::full() const {
  const std::lock_guard lock(mutex_);
  return running_ >= limits_.running && !fits(Priority::interactive, kSmallCost) &&
         greediest(waiting_costs(Priority::interactive)).second <= kSmallCost;
}

Clock::duration Admission::shortest_client_wait() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Clock::time_point> first;  // by client
  for (const QueueEntry& w : works_)
    if (w.state == State::waits && w.entry == Entry::first && w.demand.priority == Priority::interactive &&
        !has_many_preempted(w.demand))
      first.emplace(w.demand.client, w.since);
  Clock::duration least = Clock::duration::max();
  for (const auto& [client, since] : first) least = std::min(least, timer_.now() - since);
  return first.empty() ? Clock::duration{} : least;
}

Admission::Ticket Admission::enter(const SlotRequest& demand, const std::stop_token& stop) {
  return enter(demand, Entry::first, stop);
}
Admission::Ticket Admission::enter_again(const SlotRequest& demand, const std::stop_token& stop) {
  return enter(demand, Entry::next, stop);
}

Admission::Ticket Admission::enter(const SlotRequest& demand, Entry entry, const std::stop_token& stop) {
  HandlerSlots::Wait wait;  // destroyed after `lock`
  std::unique_lock lock(mutex_);
  if (entry == Entry::first && !may_begin(demand, entry)) make_room(demand);
  const double charge = std::min(demand.cost, kFixedCost + rays_in(kMinTimeSlice, limits_.running));
  const auto work = works_.emplace(works_.end(), demand, entry, charge);
  try {
    wait_for_slot(lock, *work, stop);
  } catch (...) {
    works_.erase(work);
    start_next();
    throw;
  }
  lock.unlock();
  wait.end_without_slot();
  try {
    return Ticket(*this, *work, stop);
  } catch (...) {
    leave(*work, false);
    throw;
  }
}

Admission::Ticket::Ticket(Admission& from, QueueEntry& work, std::stop_token stop)
    : from_(&from), work_(&work), stop_(std::move(stop)) {
  set_alarms();
}

Admission::Ticket::Ticket(Ticket&& other) noexcept
    : from_(other.from_),
      work_(std::exchange(other.work_, nullptr)),
      stop_(std::move(other.stop_)),
      other_clients_alarm_(std::move(other.other_clients_alarm_)),
      all_clients_alarm_(std::move(other.all_clients_alarm_)) {}

Admission::Ticket::~Ticket() {
  other_clients_alarm_.reset();
  all_clients_alarm_.reset();
  if (!work_) return;
  from_->leave(*work_, std::uncaught_exceptions() <= exceptions_);
  HandlerSlots::resume();
}

void Admission::Ticket::set_alarms() {
  const auto start_next = [from = from_] {
    const std::lock_guard lock(from->mutex_);
    from->start_next();
  };
  const auto after = [&](Clock::duration held) {
    return std::unique_ptr<Timer::Alarm>(new Timer::Alarm(from_->timer_.at(work_->since + held, start_next)));
  };
  other_clients_alarm_ = after(kMinTimeSlice);
  all_clients_alarm_ = after(kOwnClientTimeSlice);
}

void Admission::Ticket::set_cost(double rays) {
  const std::lock_guard lock(from_->mutex_);
  work_->demand.cost = rays;
}

bool Admission::Ticket::expired() const { return work_->state != State::runs; }

void Admission::Ticket::renew() {
  if (!expired()) return;
  HandlerSlots::Wait wait(WaitState::Kind::begun);
  std::unique_lock lock(from_->mutex_);
  const auto place = std::find_if(from_->works_.begin(), from_->works_.end(),
                                  [&](const QueueEntry& work) { return &work == work_; });
  from_->works_.splice(from_->works_.end(), from_->works_, place);
  work_->entry = Entry::again;
  work_->used += from_->charge_overruns(*work_);
  work_->charge = kFixedCost;
  from_->wait_for_slot(lock, *work_, stop_);
  lock.unlock();
  wait.end_without_slot();
  set_alarms();
}

Admission::Subscription::Subscription(Admission& in, std::shared_ptr<Subscribers> subscribers,
                                      std::string client)
    : in_(in), subscribers_(std::move(subscribers)), client_(std::move(client)) {
  const std::lock_guard lock(in_.mutex_);
  subscribers_->insert(client_);
  update_works();
  in_.start_next();
}

Admission::Subscription::~Subscription() {
  const std::lock_guard lock(in_.mutex_);
  subscribers_->erase(subscribers_->find(client_));
  update_works();
  in_.start_next();  // requests of `client_` may now preempt the work earlier
}

void Admission::Subscription::update_works() {
  for (QueueEntry& work : in_.works_)
    if (work.demand.subscribers == subscribers_) in_.update_wishes(work);
}

void Admission::update_wishes(QueueEntry& work) {
  const SlotRequest& demand = work.demand;
  const auto wants = [&](const std::string& client) {
    return demand.is_shared() ? demand.subscribers->count(client) > 0 : client == demand.client;
  };
  const auto add = [&](const std::string& client) {
    if (!work.is_wanted_by(client))
      work.wishes.emplace(client, ClientShare{virtual_finish(work, client), timer_.now()});
  };
  if (demand.is_shared())
    std::for_each(demand.subscribers->begin(), demand.subscribers->end(), add);
  else
    add(demand.client);
  std::erase_if(work.wishes, [&](const auto& entry) {
    if (wants(entry.first)) return false;
    if (work.has_begun()) charge_overrun(work, entry.first, entry.second.since);
    return true;
  });
}

double Admission::QueueEntry::finish() const {
  const auto earlier = [](const auto& a, const auto& b) { return a.second.finish < b.second.finish; };
  return std::min_element(wishes.begin(), wishes.end(), earlier)->second.finish;
}

void Admission::wait_for_slot(std::unique_lock<std::mutex>& lock, QueueEntry& work,
                              const std::stop_token& stop) {
  const Priority priority = work.demand.priority;
  const auto asked = work.since = timer_.now();
  work.wishes.clear();
  update_wishes(work);
  work.state = State::waits;
  start_next();
  work.changed.wait(lock, stop, [&] { return work.state != State::waits; });
  if (work.has_begun()) {  // the next checkpoint reports a stop or a preemption
    waits_[static_cast<int>(priority)].Observe(std::chrono::duration<double>(timer_.now() - asked).count());
    return;
  }
  const State state = work.state.exchange(State::dropped);
  if (state == State::waits) throw Cancelled();
  throw ClientLimitExceeded(
      "queue is full: request was dropped because this client has the most rays queued (limit " +
          in_millions(limits_.max_queued_rays) + ", max_queued_rays)",
      retry_after_s(priority), "max_queued_rays");
}

void Admission::update_backlog() {
  for (const Priority priority : {Priority::interactive, Priority::batch}) {
    auto& since = waited_since_[static_cast<int>(priority)];
    const bool waits = std::any_of(works_.begin(), works_.end(), [&](const QueueEntry& w) {
      return w.state == State::waits && w.demand.priority == priority;
    });
    if (!waits) since.reset();
    if (waits && !since) since = timer_.now();
  }
}

void Admission::start_next() {
  update_backlog();
  for (QueueEntry* work = next(); work; work = next()) {
    if (!has_free_slot(work->demand.priority)) {
      QueueEntry& other = *preemption_victim(work->demand);
      other.charged_from = charged_from(other);
      other.state = State::lost;
      ++preemptions_;
      release_slot(other);
    }
    begin(*work);
  }
  update_backlog();
}

void Admission::begin(QueueEntry& work) {
  if (running_++ == 0) measured_ = timer_.now();
  if (work.demand.priority == Priority::batch) ++running_batch_;
  latest_ = work.demand.priority;
  double& virtual_time = virtual_time_[static_cast<int>(latest_)];
  virtual_time = std::max(virtual_time, work.finish());
  std::erase_if(overruns_[static_cast<int>(latest_)],
                [&](const auto& overrun) { return overrun.second <= virtual_time; });
  work.since = timer_.now();
  work.charged_from.reset();
  work.state = State::runs;
  work.changed.notify_one();
}

void Admission::leave(QueueEntry& work, bool done) {
  const std::lock_guard lock(mutex_);
  if (done)
    measure(work.demand.cost);
  else if (running_ > 0)
    measured_ = timer_.now();  // aborted: the traced rays are unknown
  if (work.state == State::runs) release_slot(work);
  if (work.state != State::dropped) charge_overruns(work);
  works_.remove_if([&](const QueueEntry& other) { return &other == &work; });
  start_next();
}

double Admission::charge_overruns(const QueueEntry& work) {
  for (const auto& [client, wish] : work.wishes) charge_overrun(work, client, wish.since);
  return kFixedCost + rays_in(timer_.now() - work.since, limits_.running);
}

void Admission::charge_overrun(const QueueEntry& work, const std::string& client, Clock::time_point since) {
  const int priority = static_cast<int>(work.demand.priority);
  const auto from = std::max(since, work.charged_from.value_or(charged_from(work)));
  const double used = kFixedCost + rays_in(timer_.now() - from, limits_.running);
  const bool came_later = since > work.since;  // joined work that was already running
  const double overrun = used - (came_later ? kFixedCost : std::max(kFixedCost, work.charge));
  if (overrun <= 0) return;
  const double most = virtual_time_[priority] + kMaxDebt * rays_in(kMinTimeSlice, limits_.running);
  double& until = overruns_[priority][client];
  until = std::max(until, std::min(std::max(until, virtual_time_[priority]) + overrun, most));
}

Clock::time_point Admission::charged_from(const QueueEntry& work) const {
  const auto& waited = waited_since_[static_cast<int>(work.demand.priority)];
  return waited ? std::max(work.since, *waited) : timer_.now();
}

void Admission::release_slot(const QueueEntry& work) {
  --running_;
  if (work.demand.priority == Priority::batch) --running_batch_;
}

bool Admission::has_free_slot(Priority priority) const {
  if (running_ >= limits_.running) return false;
  return priority == Priority::interactive || running_batch_ < std::max(1, limits_.running / 2);
}

Admission::QueueEntry* Admission::preemption_victim(const SlotRequest& demand) {
  const auto now = timer_.now();
  QueueEntry* best = nullptr;
  for (QueueEntry& work : works_) {
    const auto keeps_it = is_for_its_own(demand, work) ? kOwnClientTimeSlice : kMinTimeSlice;
    if (work.state != State::runs || now - work.since < keeps_it) continue;
    const Priority priority = demand.priority;
    const bool gives =
        priority == Priority::interactive || work.demand.priority == priority || running_batch_ == 0;
    if (gives && (!best || work.since < best->since)) best = &work;
  }
  return best;
}

bool Admission::is_for_its_own(const SlotRequest& demand, const QueueEntry& work) {
  const auto wants = [&](const std::string& client) { return work.is_wanted_by(client); };
  if (!demand.is_shared()) return wants(demand.client);
  return std::all_of(demand.subscribers->begin(), demand.subscribers->end(), wants);
}

bool Admission::may_begin(const SlotRequest& demand, Entry entry) {
  if (entry == Entry::first && has_many_preempted(demand)) return false;
  return has_free_slot(demand.priority) || preemption_victim(demand);
}

Admission::QueueEntry* Admission::next() {
  QueueEntry* best = nullptr;
  const bool batch_starves = running_batch_ == 0 && latest_ != Priority::batch;
  const auto rank = [&](const QueueEntry& w) {
    const bool first = batch_starves == (w.demand.priority == Priority::batch);
    return std::pair(first ? 0 : 1, w.finish());
  };
  for (QueueEntry& work : works_) {
    if (work.state != State::waits) continue;
    if (best && !(rank(work) < rank(*best))) continue;
    if (may_begin(work.demand, work.entry)) best = &work;
  }
  return best;
}

// Returns the virtual finish time of `work` for one of its clients. Preempted work does not queue behind
// later requests of the client.
double Admission::virtual_finish(const QueueEntry& work, const std::string& client) const {
  const bool again = work.entry == Entry::again;
  const int priority = static_cast<int>(work.demand.priority);
  const auto overrun = overruns_[priority].find(client);
  double start =
      std::max(virtual_time_[priority], overrun == overruns_[priority].end() ? 0 : overrun->second);
  for (const QueueEntry& w : works_)
    if (w.state == State::waits && w.demand.priority == work.demand.priority && w.is_wanted_by(client) &&
        (!again || w.entry == Entry::again))
      start = std::max(start, w.wishes.at(client).finish);
  return start + work.charge;
}

bool Admission::has_many_preempted(const SlotRequest& demand) const {
  const auto lost_many = [&](const std::string& client) {
    return has_many_preempted(demand.priority, client);
  };
  if (!demand.is_shared()) return lost_many(demand.client);
  return std::all_of(demand.subscribers->begin(), demand.subscribers->end(), lost_many);
}

bool Admission::has_many_preempted(Priority priority, const std::string& client) const {
  const auto lost = std::count_if(works_.begin(), works_.end(), [&](const QueueEntry& w) {
    const bool has_lost = w.state == State::lost || (w.state == State::waits && w.entry == Entry::again);
    return has_lost && w.demand.priority == priority && (w.demand.client == client || w.is_wanted_by(client));
  });
  return lost >= 2 * limits_.running;
}

std::map<std::string, double> Admission::waiting_costs(Priority priority) const {
  std::map<std::string, double> costs;
  for (const QueueEntry& w : works_)
    if (w.counts && (w.state == State::waits || w.state == State::lost) && w.demand.priority == priority)
      costs[w.demand.client] += std::max(std::min(kFixedCost, w.demand.cost), w.demand.cost - w.used);
  return costs;
}

double Admission::waiting_cost(Priority priority) const {
  double sum = 0;
  for (const auto& [client, cost] : waiting_costs(priority)) sum += cost;
  return sum;
}

bool Admission::fits(Priority priority, double cost) const {
  const double waiting = waiting_cost(priority);
  return waiting == 0 || waiting + cost <= limits_.max_queued_rays;
}

Admission::QueueEntry* Admission::newest_droppable(Priority priority, const std::string& client) {
  const auto newest = std::find_if(works_.rbegin(), works_.rend(), [&](const QueueEntry& w) {
    return w.entry == Entry::first && w.state == State::waits && w.demand.priority == priority &&
           w.demand.client == client;
  });
  return newest == works_.rend() ? nullptr : &*newest;
}

// Drops unstarted requests of the client with the most queued work until `demand` fits. Throws LimitExceeded
// or ClientLimitExceeded if the client of `demand` would have the most. Started work cannot be dropped. If
// nothing else is queued, `demand` is admitted beyond the limit, so that started work does not lock out other
// clients.
void Admission::make_room(const SlotRequest& demand) {
  const Priority priority = demand.priority;
  while (!fits(priority, demand.cost)) {
    const auto costs = waiting_costs(priority);
    const auto [greedy, most] = greediest(costs);
    const auto known = costs.find(demand.client);
    const double own = known == costs.end() ? 0 : known->second;
    if (greedy == demand.client || own + demand.cost >= most) refuse(priority, own);
    QueueEntry* const dropped = newest_droppable(priority, greedy);
    if (!dropped) return;
    dropped->state = State::dropped;
    dropped->changed.notify_one();
  }
}

void Admission::refuse(Priority priority, double own) const {
  const double all = waiting_cost(priority);
  const std::string full = "queue is full: " + in_millions(all) + " rays queued",
                    limit = " (limit " + in_millions(limits_.max_queued_rays) + ", max_queued_rays)";
  if (own > 0 && own < all)
    throw ClientLimitExceeded(full + ", " + in_millions(own) + " of them by this client" + limit,
                              retry_after_s(priority), "max_queued_rays");
  throw LimitExceeded(full + limit, retry_after_s(priority), "max_queued_rays");
}

void Admission::measure(double cost) {
  const auto now = timer_.now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(measured_, now)).count();
  const double faded = std::exp(-seconds / kMemory_s);
  done_rays_ = done_rays_ * faded + cost;
  busy_s_ = busy_s_ * faded + seconds;
}

double Admission::retry_after_s(Priority priority) const {
  return limited_retry_s(waiting_cost(priority) / rays_a_second());
}

double Admission::rays_a_second() const { return busy_s_ > 0 ? done_rays_ / busy_s_ : kExpectedRate; }

}  // namespace orrery
