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
#include "server/base/errors.h"
#include "server/base/subscribers.h"
#include "server/base/timer.h"
#include "server/scheduler/worker_pool.h"
#include "server/telemetry/service_counters.h"

namespace orrery {

// Thrown for an image whose estimated cost exceeds the limit of one request.
class TooManyRays : public InputError {
 public:
  // `expected`: estimated cost. `most`: limit. Both are in usual rays; see ray_weight().
  TooManyRays(double expected, double most);
  const char* limit() const noexcept { return "request_rays"; }  // name in /v1/limits
};

// Returns the Retry-After in seconds for a predicted wait: `seconds` clamped to [1, 30].
inline double limited_retry_s(double seconds) { return std::clamp(seconds, 1.0, 30.0); }

// Limit on concurrent items of one kind. require_one_more() throws LimitExceeded if `all`, the number of
// items, is at least `most`. It throws ClientLimitExceeded if `own`, the number of items of the client, is at
// least max(1, most / 2), rounded down.
struct Quota {
  const char *noun, *state, *limit;  // for messages: "job", "running", "jobs" (setting)
  int most;
  double retry_s;
  void require_one_more(int all, int own) const;
};

// interactive: short work whose client waits for the response. batch: jobs and expensive images.
enum class Priority { interactive, batch };

// Request for a slot.
struct SlotRequest {
  Priority priority = Priority::interactive;
  std::string client;                             // client that requested the work first
  double cost = 0;                                // estimated rays
  std::shared_ptr<Subscribers> subscribers = {};  // all clients of shared work; null: not shared
  bool is_shared() const { return subscribers && !subscribers->empty(); }
};

inline constexpr double kFixedCost = 20'000;  // fixed cost of a render, in rays
// Returns the estimated cost of parsing `bytes` of JSON or mesh data, in rays.
double cost_of_reading(std::size_t bytes);

// Fair queue for a fixed number of slots. Each priority has its own queue with limited estimated cost.
//  - Interactive work has precedence. Batch work holds at most half of the slots. While no batch work runs,
//    every second slot that becomes free goes to waiting batch work.
//  - Within a priority, clients share the slots equally by estimated cost. Work starts in the order of
//    virtual finish times (self-clocked fair queueing: Golestani, INFOCOM 1994). Time in a slot beyond the
//    estimate is also charged to the client. Work of several clients has the earliest of their finish times
//    and is charged to each of them.
//  - Waiting work preempts work that has held its slot for 50 ms, or for 200 ms if both have the same client.
//    Interactive work preempts any work. Batch work preempts batch work, and interactive work while no batch
//    work has a slot. Preempted work continues until it renews its ticket, and then waits in the queue. A
//    client with too much preempted work starts no new work; see has_many_preempted().
//  - When the queue of a priority is full, the client with the most queued work loses requests to clients
//    with less (longest queue drop: McKenney, "Stochastic Fairness Queueing", 1990).
// Thread-safe.
class Admission {
  struct QueueEntry;

 public:
  struct Limits {
    int running;             // number of slots
    double max_queued_rays;  // maximum estimated cost of a queue; an empty queue accepts any cost
  };
  // `timer` must outlive this object.
  Admission(const Limits& limits, Timer& timer) : limits_(limits), timer_(timer) {}

  // Lease of a slot, released by the destructor. Unless an exception is being thrown, the destructor counts
  // the work as done, at the estimated cost or that of set_cost(). The lease expires when the work is
  // preempted. renew() charges the used time to the client and waits for another slot. While the lease
  // exists, the handler of the thread needs no slot of HandlerSlots. It takes one again at the end of the
  // lease.
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
    std::unique_ptr<Timer::Alarm> other_clients_alarm_, all_clients_alarm_;  // ends of the time slices
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
  int waiting() const;  // includes preempted work that has not reached its next checkpoint
  // Returns whether a small request of a client without queued work would be rejected.
  bool full() const;
  std::uint64_t preemptions() const { return preemptions_; }  // since the start of the service
  // Returns the shortest wait of the clients with queued interactive work, or 0 if there are no such clients.
  // The wait of a client is that of its oldest unstarted request. Clients with too much preempted work are
  // excluded, because they wait for their own work.
  Clock::duration shortest_client_wait() const;
  // Returns the histogram of the waiting times in the queue.
  const SecondsHistogram& waits(Priority priority) const { return waits_[static_cast<int>(priority)]; }

  // Waits for a slot. Throws ClientLimitExceeded or LimitExceeded if the queue is full. Retry-After is the
  // queued cost divided by the measured rate. Throws Cancelled once `stop` is requested.
  Ticket enter(const SlotRequest& demand, const std::stop_token& stop);
  // Waits for a slot like enter(), for the next part of work that has started. Never rejects or drops it.
  Ticket enter_again(const SlotRequest& demand, const std::stop_token& stop);

 private:
  enum class Entry { first, next, again };          // new, continuing or preempted work
  enum class State { waits, runs, lost, dropped };  // lost: preempted; dropped: cancelled or evicted
  struct ClientShare {                              // one client's interest in an entry
    double finish;                                  // virtual finish time
    Clock::time_point since;                        // time when the client joined
  };
  struct QueueEntry {
    QueueEntry(const SlotRequest& d, Entry e, double c)
        : demand(d), entry(e), counts(e == Entry::first), charge(c) {}
    double finish() const;  // earliest of all clients
    bool is_wanted_by(const std::string& client) const { return wishes.count(client) > 0; }
    bool has_begun() const { return state == State::runs || state == State::lost; }

    SlotRequest demand;
    Entry entry;
    const bool counts;  // whether it counts towards max_queued_rays
    std::atomic<State> state{State::waits};
    double charge;                                  // rays charged in advance for the slot
    double used = 0;                                // estimated rays in slots lost to preemption
    std::map<std::string, ClientShare> wishes;      // by client
    Clock::time_point since{};                      // start of its time in the queue or slot
    std::optional<Clock::time_point> charged_from;  // start of the charged time; set by preemption
    std::condition_variable_any changed;
  };
  using QueueEntries = std::list<QueueEntry>;

  Ticket enter(const SlotRequest& demand, Entry entry, const std::stop_token& stop);
  void leave(QueueEntry& work, bool done);
  // REQUIRES for the functions below: mutex_ is held. wait_for_slot() releases `lock` while it waits. It
  // throws Cancelled, or ClientLimitExceeded if the request is dropped from a full queue.
  void wait_for_slot(std::unique_lock<std::mutex>& lock, QueueEntry& work, const std::stop_token& stop);
  void begin(QueueEntry& work);
  // Charges `client` for time in the slot beyond the advance charge. Time before other work began to wait is
  // free: a client that had the service to itself owes nothing to later clients.
  void charge_overrun(const QueueEntry& work, const std::string& client, Clock::time_point since);
  // Charges all clients of the work. Returns the estimated rays that it has used in its slot.
  double charge_overruns(const QueueEntry& work);
  Clock::time_point charged_from(const QueueEntry& work) const;
  void update_backlog();  // updates waited_since_
  void release_slot(const QueueEntry& work);
  void start_next();
  void make_room(const SlotRequest& demand);
  bool fits(Priority priority, double cost) const;
  bool has_free_slot(Priority priority) const;
  QueueEntry* preemption_victim(const SlotRequest& demand);  // running work to preempt, or nullptr
  // Returns whether every client of `demand` is also a client of `work`.
  static bool is_for_its_own(const SlotRequest& demand, const QueueEntry& work);
  void update_wishes(QueueEntry& work);  // call after a change of its subscribers
  double virtual_finish(const QueueEntry& work, const std::string& client) const;
  // Returns whether each client of `demand` has at least twice as many preempted entries as there are slots.
  // Such clients start no new work, which bounds the started work and its memory. An entry also counts for
  // the client that requested it first, even after that client has disconnected.
  bool has_many_preempted(const SlotRequest& demand) const;
  bool has_many_preempted(Priority priority, const std::string& client) const;
  bool may_begin(const SlotRequest& demand, Entry entry);  // whether it could get a slot now
  QueueEntry* next();                                      // work to start now, or nullptr
  // Return the cost of the queued work in a priority, by client and in total. Work of enter_again() is
  // excluded.
  std::map<std::string, double> waiting_costs(Priority priority) const;
  double waiting_cost(Priority priority) const;
  // Returns the newest unstarted request of the client, or nullptr if there is none.
  QueueEntry* newest_droppable(Priority priority, const std::string& client);
  [[noreturn]] void refuse(Priority priority, double own) const;  // `own`: queued cost of the client
  double retry_after_s(Priority priority) const;
  double rays_a_second() const;
  void measure(double cost);

  const Limits limits_;
  Timer& timer_;
  SecondsHistogram waits_[2];  // by priority
  std::atomic<std::uint64_t> preemptions_{0};
  mutable std::mutex mutex_;  // guards the members below
  QueueEntries works_;        // waiting and running, in order of arrival; preempted work moves to the end
  int running_ = 0, running_batch_ = 0;
  Priority latest_ = Priority::interactive;           // priority of the latest start
  double virtual_time_[2] = {0, 0};                   // by priority: latest finish time of started work
  std::map<std::string, double> overruns_[2];         // by priority and client: end of debt, virtual time
  std::optional<Clock::time_point> waited_since_[2];  // by priority: time when the queue became non-empty
  // Measured rate: rays of finished work and busy seconds, both with exponential decay.
  double done_rays_ = 0, busy_s_ = 0;
  Clock::time_point measured_;
};

}  // namespace orrery
