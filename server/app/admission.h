#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/render/worker_pool.h"
#include "server/app/service_counters.h"
#include "server/app/subscribers.h"
#include "server/app/timer.h"
#include "server/http/limit_exceeded.h"

namespace orrery {

// Error for an image whose estimated cost exceeds the limit of one request.
class TooManyRays : public InputError {
 public:
  // `expected`: estimated cost in usual rays. `most`: the limit.
  TooManyRays(double expected, double most);
  const char* limit() const noexcept { return "request_rays"; }  // name in /v1/limits
};

// Returns the value of Retry-After for a predicted wait, clamped to 1 to 30 seconds.
inline double limited_retry_s(double seconds) { return std::clamp(seconds, 1.0, 30.0); }

// Limit on concurrent items of one kind. require_one_more() throws LimitExceeded if `all` items have reached
// `most`, and ClientLimitExceeded if the client's `own` items have reached half of it.
struct Quota {
  const char *noun, *state, *limit;  // in messages: "job", "running" and "jobs"
  int most;
  double retry_s;
  void require_one_more(int all, int own) const;
};

enum class Priority { interactive, batch };  // interactive: a client waits for it; batch: long work

// Request for a slot.
struct SlotRequest {
  Priority priority = Priority::interactive;
  std::string client;  // client that requested it first; its only client unless shared
  double cost = 0;     // estimated rays
  std::shared_ptr<Subscribers> subscribers = {};  // null: cannot be shared
  bool is_shared() const { return subscribers && !subscribers->empty(); }
};

inline constexpr double kFixedCost = 20'000;  // fixed cost of a render, in rays
// Returns the estimated cost of parsing `bytes` of JSON or mesh data, in rays.
double cost_of_reading(std::size_t bytes);

// Fair queue for a fixed number of slots. Limits the estimated cost of the queued work in each priority.
//  - Interactive work goes first. Batch work has at most half of the slots, and gets every second free slot
//    while none of it runs.
//  - Within a priority, clients share by estimated cost. Work starts in the order of its client's virtual
//    finish time (self-clocked fair queueing: Golestani, INFOCOM 1994). Time in a slot beyond the estimate is
//    also charged to the client. Work shared by several clients starts at the earliest finish time of any of
//    them, and is charged to each.
//  - Work that has held its slot for a while is preempted by waiting work: interactive work by interactive
//    work, batch work by both, and interactive work by batch work if no batch work has a slot. Work of the
//    same client preempts it later. Preempted work continues until it renews its ticket, and then waits in
//    the queue. A client with much preempted work starts no more.
//  - When a priority is full, the client with the most queued work makes room for clients with less (longest
//    queue drop: McKenney, "Stochastic Fairness Queueing", 1990).
// Safe from any thread.
class Admission {
  struct QueueEntry;

 public:
  struct Limits {
    int running;        // number of slots
    double queue_rays;  // estimated cost of the queued work in a priority; an empty lane admits any cost
  };
  // `timer` must outlive this object.
  Admission(const Limits& limits, Timer& timer) : limits_(limits), timer_(timer) {}

  // Lease of a slot, released by the destructor. The destructor counts the work as done, at the estimated
  // cost or that of set_cost(), unless an exception is being thrown. As a SlotLease, it expires when the work
  // is preempted. Renewing it charges the used time to the client and waits for another slot. The lease
  // replaces the handler's slot (HandlerSlots), which the handler takes again when the lease ends.
  class Ticket final : public SlotLease {
   public:
    Ticket(Ticket&& other) noexcept;
    ~Ticket();
    void set_cost(double rays);
    void set_stop(std::stop_token stop) { stop_ = std::move(stop); }  // cancels the wait in renew()

    bool expired() const override;
    void renew() override;  // throws Cancelled

   private:
    friend class Admission;
    Ticket(Admission& from, QueueEntry& work, std::stop_token stop);
    void set_alarms();

    Admission* from_;
    QueueEntry* work_;
    std::stop_token stop_;
    std::unique_ptr<Timer::Alarm> other_clients_alarm_, all_clients_alarm_;  // start of preemption
    int exceptions_ = std::uncaught_exceptions();
  };

  // Registers `client` as one of `subscribers` for the lifetime of this object.
  class Subscription {
   public:
    Subscription(Admission& in, std::shared_ptr<Subscribers> subscribers, std::string client);
    ~Subscription();
    Subscription(const Subscription&) = delete;

   private:
    void update_works();  // REQUIRES: in_.mutex_ is held
    Admission& in_;
    const std::shared_ptr<Subscribers> subscribers_;
    const std::string client_;
  };

  int running() const;
  int waiting() const;  // includes preempted work on its way to the next checkpoint
  // Returns whether small work of a client without queued work would be rejected.
  bool full() const;
  std::uint64_t preemptions() const { return preemptions_; }  // preemptions since the start
  // Returns the shortest wait of any client with queued interactive work, or 0 if none has any. A client's
  // wait is that of its oldest request that has not started. Clients with much preempted work do not count:
  // they wait for their own work.
  Clock::duration shortest_client_wait() const;
  // Returns the histogram of the times spent in the queue.
  const SecondsHistogram& waits(Priority priority) const { return waits_[static_cast<int>(priority)]; }

  // Waits for a slot. Throws ClientLimitExceeded or LimitExceeded if too much work is queued; Retry-After is
  // its cost divided by the measured rate. Throws Cancelled once `stop` is requested.
  Ticket enter(const SlotRequest& demand, const std::stop_token& stop);
  // Waits for a slot like enter(), for work that has begun and must continue. Never rejects or drops the
  // work.
  Ticket enter_again(const SlotRequest& demand, const std::stop_token& stop);

 private:
  enum class Entry { first, next, again };          // new, continuing or preempted work
  enum class State { waits, runs, lost, dropped };  // lost: preempted; dropped: left the queue
  struct ClientShare {                              // one client's share in a piece of work
    double finish;                                  // virtual time
    Clock::time_point since;                        // start of the share
  };
  struct QueueEntry {
    QueueEntry(const SlotRequest& d, Entry e, double c)
        : demand(d), entry(e), counts(e == Entry::first), charge(c) {}
    double finish() const;  // earliest of all wishes
    bool is_wanted_by(const std::string& client) const { return wishes.count(client) > 0; }
    bool has_begun() const { return state == State::runs || state == State::lost; }

    SlotRequest demand;
    Entry entry;
    const bool counts;  // counted in queue_rays
    std::atomic<State> state{State::waits};
    double charge;                                  // rays charged in advance for the slot
    double used = 0;                                // estimated rays in slots it has lost
    std::map<std::string, ClientShare> wishes;      // by client
    Clock::time_point since{};                      // start of its time in the slot or queue
    std::optional<Clock::time_point> charged_from;  // preempted work: start of the time to charge
    std::condition_variable_any changed;
  };
  using QueueEntries = std::list<QueueEntry>;

  Ticket enter(const SlotRequest& demand, Entry entry, const std::stop_token& stop);
  void leave(QueueEntry& work, bool done);
  // REQUIRES for the functions below: mutex_ is held. wait_for_slot() releases `lock` while it waits. It
  // throws Cancelled, or ClientLimitExceeded if new work is dropped.
  void wait_for_slot(std::unique_lock<std::mutex>& lock, QueueEntry& work, const std::stop_token& stop);
  void begin(QueueEntry& work);
  // Charges `client` for time in the slot beyond the advance charge, as far as other work waited. Time
  // without a queue is free: a client that had the service to itself owes nothing to later clients.
  void charge_overrun(const QueueEntry& work, const std::string& client, Clock::time_point since);
  // Charges all clients of the work. Returns the estimated rays it has used in its slot.
  double charge_overruns(const QueueEntry& work);
  Clock::time_point charged_from(const QueueEntry& work) const;
  void update_backlog();
  void release_slot(const QueueEntry& work);
  void start_next();
  void make_room(const SlotRequest& demand);
  bool fits(Priority priority, double cost) const;
  bool has_free_slot(Priority priority) const;
  QueueEntry* preemption_victim(const SlotRequest& demand);  // preemption victim, or nullptr
  static bool is_for_its_own(const SlotRequest& demand, const QueueEntry& work);  // no other client wants it
  void update_wishes(QueueEntry& work);  // after a change of its clients
  double virtual_finish(const QueueEntry& work, const std::string& client) const;
  // Returns whether each client of `demand` has at least twice as many pieces of preempted work as there are
  // slots. Such clients start no more work, which bounds begun work and its memory. Preempted work also
  // counts for the client that began it and left it to others.
  bool has_many_preempted(const SlotRequest& demand) const;
  bool has_many_preempted(Priority priority, const std::string& client) const;
  bool may_begin(const SlotRequest& demand, Entry entry);  // whether it can take a slot now
  QueueEntry* next();                                      // work to start now, or nullptr
  // Returns the cost of the queued work in a priority, by client and in total. Excludes continuing work.
  std::map<std::string, double> waiting_costs(Priority priority) const;
  double waiting_cost(Priority priority) const;
  QueueEntry* newest_droppable(Priority priority, const std::string& client);  // or nullptr
  [[noreturn]] void refuse(Priority priority, double own) const;  // cost of the client's queued work
  double retry_after_s(Priority priority) const;
  double rays_a_second() const;
  void measure(double cost);

  const Limits limits_;
  Timer& timer_;
  SecondsHistogram waits_[2];  // by priority
  std::atomic<std::uint64_t> preemptions_{0};
  mutable std::mutex mutex_;  // guards all below
  QueueEntries works_;        // waiting work in order of arrival
  int running_ = 0, running_batch_ = 0;
  Priority latest_ = Priority::interactive;           // priority of the last start
  double virtual_time_[2] = {0, 0};                   // by priority: finish time of the last start
  std::map<std::string, double> overruns_[2];         // by priority and client: virtual time of debts
  std::optional<Clock::time_point> waited_since_[2];  // by priority: since when work has been waiting
  // Measured rate: rays of work done and busy seconds, both with exponential decay.
  double done_rays_ = 0, busy_s_ = 0;
  Clock::time_point measured_;
};

}  // namespace orrery
