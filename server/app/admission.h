#pragma once

#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "server/app/meters.h"
#include "server/app/timer.h"
#include "server/http/over_limit.h"

namespace orrery {

// This client has so much work waiting that what it asks for now, or last, is turned away.
class ClientBusy : public OverLimit {
 public:
  using OverLimit::OverLimit;
};

// A picture is expected to cost more than one request may ask for.
class TooManyRays : public InputError {
 public:
  // Of a picture that is expected to take so many rays, where so many are the limit.
  TooManyRays(double expected, double most);
  const char* limit() const noexcept { return "request_rays"; }  // its name in /v1/limits
};

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
  std::string client;  // who asked for it
  double cost = 0;     // rays, as expected
};

inline constexpr double kLeastCost = 20'000;  // rays that the fixed work of a render amounts to
// What reading so many bytes of JSON or of a mesh is expected to cost, in rays.
double cost_of_reading(std::size_t bytes);

// Lets a few pieces of work run at once; what waits in a lane is bounded by its cost.
//  - Interactive work goes first. Batch work has at most half of the places, and one of every two that
//    come free as long as it has none.
//  - Within a lane, clients share by cost: each piece starts in the order of its client's virtual finish
//    time (self-clocked fair queueing: Golestani, INFOCOM 1994), however much the others ask for.
//  - When a lane is full, who has most waiting in it makes room for who has less (longest queue drop:
//    McKenney, "Stochastic Fairness Queueing", 1990).
// Safe from any thread.
class Admission {
 public:
  struct Limits {
    int running;        // pieces of work at once
    double queue_rays;  // expected cost of what waits in a lane; one may wait whatever it costs
  };
  // `timer` must outlive it.
  Admission(const Limits& limits, const Timer& timer) : limits_(limits), timer_(timer) {}

  // The right to work. Ends with the object, and unless that is by an exception, the work was done: at the
  // cost that was expected, or that set_cost() has told.
  class Ticket {
   public:
    Ticket(Admission& from, Lane lane, double cost) : from_(&from), lane_(lane), cost_(cost) {}
    Ticket(Ticket&& other) noexcept
        : from_(std::exchange(other.from_, nullptr)), lane_(other.lane_), cost_(other.cost_) {}
    void set_cost(double rays) { cost_ = rays; }
    ~Ticket() {
      if (from_) from_->leave(lane_, std::uncaught_exceptions() > exceptions_ ? 0 : cost_);
    }

   private:
    Admission* from_;
    Lane lane_;
    double cost_;
    int exceptions_ = std::uncaught_exceptions();
  };

  int running() const;
  int waiting() const;
  // Whether small work would be turned away.
  bool full() const;
  // From asking for a turn to having it.
  const SecondsHistogram& waits(Lane lane) const { return waits_[static_cast<int>(lane)]; }

  // Waits for a place. Throws ClientBusy or Busy if too much waits already, with the time after which that
  // will be done at the rate measured; Cancelled once `stop` is requested.
  Ticket enter(const Demand& demand, const std::stop_token& stop);
  // As enter(), for work that began and must go on: never too much waits, and it is not turned away.
  Ticket enter_again(const Demand& demand, const std::stop_token& stop);

 private:
  struct Waiting {
    Waiting(const Demand& d, bool droppable, double f) : demand(d), may_be_dropped(droppable), finish(f) {}
    Demand demand;
    bool may_be_dropped;
    double finish;  // virtual time
    enum { waits, starts, dropped } state = waits;
    std::condition_variable_any changed;
  };
  using Queue = std::list<Waiting>;  // in order of arrival; who starts leaves it

  Ticket wait_for_turn(std::unique_lock<std::mutex>& lock, const Demand& demand, bool may_be_dropped,
                       const std::stop_token& stop);
  void leave(Lane lane, double cost);
  // Below: with mutex_ held.
  void start_next();
  void make_room(const Demand& demand);
  bool fits(Lane lane, double cost) const;
  bool place_free(Lane lane) const;
  double virtual_finish(const Demand& demand) const;
  Queue::iterator next();  // who may start now; end: none
  // Of a lane, without work that began: all, or one client's.
  double waiting_cost(Lane lane, const std::string* client = nullptr) const;
  Queue::iterator newest_of_greediest(Lane lane);
  double retry_after_s(Lane lane) const;
  void measure(double cost);

  const Limits limits_;
  const Timer& timer_;
  SecondsHistogram waits_[2];  // of a lane
  mutable std::mutex mutex_;   // guards all below
  Queue queue_;
  int running_ = 0, running_batch_ = 0;
  Lane latest_ = Lane::interactive;  // that had a turn
  double virtual_time_[2] = {0, 0};  // of a lane: finish of the piece that started last
  // The measured rate: rays of work done and seconds in which something ran, recent ones counting more.
  double done_rays_ = 0, busy_s_ = 0;
  Clock::time_point measured_;
};

}  // namespace orrery
