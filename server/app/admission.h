#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>

#include "server/app/frame.h"

namespace orrery {

// Lets a few renders run at once and a bounded number wait for their turn, first come, first served.
class Admission {
 public:
  Admission(int most_running, int most_waiting) : most_running_(most_running), most_waiting_(most_waiting) {}

  // The right to render. Ends with the object.
  class Ticket {
   public:
    explicit Ticket(Admission& from) : from_(&from), start_(Clock::now()) {}
    Ticket(Ticket&& other) noexcept : from_(std::exchange(other.from_, nullptr)), start_(other.start_) {}
    ~Ticket() {
      if (from_) from_->leave(milliseconds_since(start_));
    }

   private:
    Admission* from_;
    Clock::time_point start_;
  };

  int running() const;
  int waiting() const;
  // Whether one more would be turned away.
  bool full() const;

  using Stop = std::function<bool()>;

  // Waits for a place. Throws Busy if too many wait already; Cancelled once `stop` says so, which is asked
  // every 20 ms while waiting.
  Ticket enter(const Stop& stop);
  // As enter(), for work that began and must go on: never too many wait.
  Ticket enter_again(const Stop& stop);

 private:
  Ticket wait_for_turn(std::unique_lock<std::mutex>& lock, const Stop& stop);
  void leave(double milliseconds);
  double retry_after_s() const;
  bool overrun() const {  // with mutex_ held
    return running_ >= most_running_ && static_cast<int>(waiting_.size()) >= most_waiting_;
  }

  const int most_running_, most_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int running_ = 0;
  std::list<int> waiting_;  // one entry each, the first is next
  double mean_ms_ = 100;    // of a render, recent ones counting more
};

}  // namespace orrery
