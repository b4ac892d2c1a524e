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
#include "server/app/meters.h"
#include "server/app/sharers.h"
#include "server/app/timer.h"
#include "server/http/over_limit.h"

namespace orrery {

// A picture is expected to cost more than one request may ask for.
class TooManyRays : public InputError {
 public:
  // Of a picture that is expected to take as long as so many rays, where so many are the limit.
  TooManyRays(double expected, double most);
  const char* limit() const noexcept { return "request_rays"; }  // its name in /v1/limits
};

// When who was refused may come back: Retry-After, in seconds.
inline double limited_retry_s(double seconds) { return std::clamp(seconds, 1.0, 30.0); }

// Holds that there is a place for one more of `what`, of which there are `all` now, `own` of them this
// client's: at most `most` (the limit called `limit`), and half of them for one client. Throws Busy or
// ClientBusy.
struct Quota {
  const char *what, *limit;  // "jobs are under way", "jobs"
  int most;
  double retry_s;
  void require_one_more(int all, int own) const;
};

enum class Lane { interactive, batch };  // somebody waits for it; or it is long

// A piece of work that waits for its turn.
struct Demand {
  Lane lane = Lane::interactive;
  std::string client;                     // who asked for it first, and wants it where nobody shares it
  double cost = 0;                        // rays, as expected
  std::shared_ptr<Sharers> sharers = {};  // nobody can share it: null
  bool is_shared() const { return sharers && !sharers->empty(); }
};

inline constexpr double kLeastCost = 20'000;  // rays that the fixed work of a render amounts to
// What reading so many bytes of JSON or of a mesh is expected to cost, in rays.
double cost_of_reading(std::size_t bytes);

// Lets a few pieces of work run at once; what waits in a lane is bounded by its cost.
//  - Interactive work goes first. Batch work has at most half of the places, and one of every two that
//    come free as long as it has none.
//  - Within a lane, clients share by cost: each piece starts in the order of its client's virtual finish
//    time (self-clocked fair queueing: Golestani, INFOCOM 1994), however much the others ask for. The time
//    that work had a place beyond what was expected counts as work of its client, too. Work that several
//    clients want starts in the earliest turn of any of them, and counts as work of each.
//  - Work that has had its place for a while loses it to who waits: interactive work to interactive work,
//    batch work to both, and interactive work to batch work while none of that has a place. To work of its
//    own client it loses it after a longer while. It goes on with what it does until it renews its ticket,
//    which waits in the queue. A client that has lost many places begins no more.
//  - When a lane is full, who has most waiting in it makes room for who has less (longest queue drop:
//    McKenney, "Stochastic Fairness Queueing", 1990).
// Safe from any thread.
class Admission {
  struct Work;

 public:
  struct Limits {
    int running;        // pieces of work at once
    double queue_rays;  // expected cost of what waits in a lane; one may wait whatever it costs
  };
  // `timer` must outlive it.
  Admission(const Limits& limits, Timer& timer) : limits_(limits), timer_(timer) {}

  // The right to work. Ends with the object, and unless that is by an exception, the work was done: at the
  // cost that was expected, or that set_cost() has told. As a Pass it is expired once it has lost its place;
  // to be renewed it waits for another, and what was used counts as work of its client. It stands for the
  // slot of a handler (HandlerSlots), which gets that back when the ticket ends.
  class Ticket final : public Pass {
   public:
    Ticket(Ticket&& other) noexcept;
    ~Ticket();
    void set_cost(double rays);
    void set_stop(std::stop_token stop) { stop_ = std::move(stop); }  // of waiting once it is renewed

    bool expired() const override;
    void renew() override;  // throws Cancelled

   private:
    friend class Admission;
    Ticket(Admission& from, Work& work, std::stop_token stop);
    void set_alarms();

    Admission* from_;
    Work* work_;
    std::stop_token stop_;
    std::unique_ptr<Timer::Alarm> others_may_have_it_, all_may_have_it_;  // its place
    int exceptions_ = std::uncaught_exceptions();
  };

  // Says that `client` wants the work of those sharers, until its end.
  class Sharing {
   public:
    Sharing(Admission& in, std::shared_ptr<Sharers> sharers, std::string client);
    ~Sharing();
    Sharing(const Sharing&) = delete;

   private:
    void update_works();  // with the mutex of in_ held
    Admission& in_;
    const std::shared_ptr<Sharers> sharers_;
    const std::string client_;
  };

  int running() const;
  int waiting() const;  // also what has lost its place, and is on its way to the next checkpoint
  // Whether small work of a client that has nothing waiting would be turned away.
  bool full() const;
  std::uint64_t places_lost() const { return places_lost_; }  // since the start
  // How long the client that waits least for its interactive work to begin has waited; none does: 0. Those
  // who have lost many places wait for their own work.
  Clock::duration longest_wait() const;
  // From asking for a turn to having it.
  const SecondsHistogram& waits(Lane lane) const { return waits_[static_cast<int>(lane)]; }

  // Waits for a place. Throws ClientBusy or Busy if too much waits already, with the time after which that
  // will be done at the rate measured; Cancelled once `stop` is requested.
  Ticket enter(const Demand& demand, const std::stop_token& stop);
  // As enter(), for work that began and must go on: never too much waits, and it is not turned away.
  Ticket enter_again(const Demand& demand, const std::stop_token& stop);

 private:
  enum class Entry { first, next, again };          // work that begins; that goes on; that has lost its place
  enum class State { waits, runs, lost, dropped };  // lost: its place; dropped: it waits no more
  struct Wish {                                     // of a client for a piece of work
    double finish;                                  // in virtual time
    Clock::time_point since;                        // it wants that work
  };
  struct Work {
    Work(const Demand& d, Entry e, double c) : demand(d), entry(e), counts(e == Entry::first), charge(c) {}
    double finish() const;  // the earliest
    bool is_wanted_by(const std::string& client) const { return wishes.count(client) > 0; }
    bool has_begun() const { return state == State::runs || state == State::lost; }

    Demand demand;
    Entry entry;
    const bool counts;  // among what may wait
    std::atomic<State> state{State::waits};
    double charge;                                  // rays that were charged for its place
    double used = 0;                                // rays, about, in the places that it has lost
    std::map<std::string, Wish> wishes;             // of the clients that want it
    Clock::time_point since{};                      // it got its place, or asked for one
    std::optional<Clock::time_point> charged_from;  // of work that lost its place: others waited since then
    std::condition_variable_any changed;
  };
  using Works = std::list<Work>;

  Ticket enter(const Demand& demand, Entry entry, const std::stop_token& stop);
  void leave(Work& work, bool done);
  // Below: with mutex_ held, but for `lock` while waiting.
  // Throws ClientBusy, but only at a first entry, or Cancelled.
  void wait_for_place(std::unique_lock<std::mutex>& lock, Work& work, const std::stop_token& stop);
  void begin(Work& work);
  // Charges a client that wants the work for what that has used meanwhile beyond what was expected, as far as
  // others waited for it. What nobody waits for is free: who had the service alone owes nothing to who comes
  // later.
  void charge_overrun(const Work& work, const std::string& client, Clock::time_point since);
  // Charges all who want it. Returns the rays, about, that it has used since it got its place.
  double charge_overruns(const Work& work);
  Clock::time_point charged_from(const Work& work) const;
  void note_who_waits();
  void give_up_place(const Work& work);
  void start_next();
  void make_room(const Demand& demand);
  bool fits(Lane lane, double cost) const;
  bool place_free(Lane lane) const;
  Work* loser(const Demand& demand);  // whose place such work may have; none: nullptr
  static bool is_for_its_own(const Demand& demand, const Work& work);  // nobody else wants it
  void update_wishes(Work& work);                                      // who wants it has changed
  double virtual_finish(const Work& work, const std::string& client) const;
  // Whether so much work of all clients that want it has lost its place, twice as much as there are places,
  // that they begin no more: what is begun stays bounded, with the memory that it holds. Who began it and
  // left it to others counts among them.
  bool has_lost_many(const Demand& demand) const;
  bool has_lost_many(Lane lane, const std::string& client) const;
  bool may_begin(const Demand& demand, Entry entry);  // as far as places go
  Work* next();                                       // who may start now; none: nullptr
  // Of a lane, by client, and all; without what enters again.
  std::map<std::string, double> waiting_costs(Lane lane) const;
  double waiting_cost(Lane lane) const;
  Work* newest_to_begin(Lane lane, const std::string& client);  // none: nullptr
  [[noreturn]] void refuse(Lane lane, double own) const;        // `own`: what the client has waiting
  double retry_after_s(Lane lane) const;
  double rays_a_second() const;
  void measure(double cost);

  const Limits limits_;
  Timer& timer_;
  SecondsHistogram waits_[2];  // of a lane
  std::atomic<std::uint64_t> places_lost_{0};
  mutable std::mutex mutex_;  // guards all below
  Works works_;               // those that wait in order of arrival
  int running_ = 0, running_batch_ = 0;
  Lane latest_ = Lane::interactive;            // that had a turn
  double virtual_time_[2] = {0, 0};            // of a lane: finish of the piece that started last
  std::map<std::string, double> overruns_[2];  // of a lane, by client: virtual time, if later than that
  std::optional<Clock::time_point>
      waited_since_[2];  // of a lane: something has waited all the time; none: nothing does
  // The measured rate: rays of work done and seconds in which something ran, recent ones counting more.
  double done_rays_ = 0, busy_s_ = 0;
  Clock::time_point measured_;
};

}  // namespace orrery
