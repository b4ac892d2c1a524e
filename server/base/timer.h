#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "core/base/clock.h"

namespace orrery {

// Clock with alarms. Abstract, so that tests can set the time. Thread-safe.
class Timer {
 public:
  using Action = std::function<void()>;

  Timer() = default;
  virtual ~Timer() = default;
  Timer(const Timer&) = delete;

  virtual Clock::time_point now() const = 0;

  // Scheduled action. The timer must outlive it. After its destructor returns, the action is not running and
  // will not run, unless the action itself destroys the alarm.
  class Alarm {
   public:
    ~Alarm() { timer_.cancel(key_); }
    Alarm(const Alarm&) = delete;

   private:
    friend class Timer;
    Alarm(Timer& timer, std::uint64_t number, Clock::time_point when) : timer_(timer), key_(when, number) {}
    Timer& timer_;
    const std::pair<Clock::time_point, std::uint64_t> key_;
  };

  // Calls `action` at `when`, or at once on the calling thread if `when` has passed. Scheduled actions run
  // one at a time and must be short. Do not destroy an alarm while holding a mutex that its action locks.
  [[nodiscard]] Alarm at(Clock::time_point when, Action action);

 protected:
  using Lock = std::unique_lock<std::mutex>;

  // Runs the first action that is due by `time`. Returns false if there is none. REQUIRES: `lock` holds
  // mutex(); it is released during the action.
  bool do_first(Lock& lock, Clock::time_point time);
  // Returns the time of the next alarm, or the maximum if there is none. REQUIRES: mutex() is held.
  Clock::time_point next_due() const;
  std::mutex& mutex() const { return mutex_; }
  // Called with mutex() held after an alarm was added that is due before all others.
  virtual void next_changed() = 0;

 private:
  using Key = std::pair<Clock::time_point, std::uint64_t>;
  void cancel(const Key& key);

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable done_;
  std::map<Key, Action> alarms_;
  std::uint64_t last_number_ = 0, being_done_ = 0;  // alarm numbers, at least 1; 0: no alarm
  std::thread::id doer_;                            // thread that runs `being_done_`
};

// Timer on the steady clock. A separate thread runs the actions.
class SteadyTimer final : public Timer {
 public:
  SteadyTimer();
  ~SteadyTimer() override;
  Clock::time_point now() const override { return Clock::now(); }

 private:
  void next_changed() override { changed_.notify_one(); }
  void run();

  std::condition_variable changed_;
  bool ends_ = false;  // guarded by mutex()
  std::thread thread_;
};

// Waits on `changed` until ready(), a stop request or `until`. Returns ready(), which is called with the
// mutex held. REQUIRES: `lock` holds the mutex that guards the state of ready(). It is released while
// waiting.
template <class Ready>
bool wait_until(Timer& timer, std::condition_variable_any& changed, std::unique_lock<std::mutex>& lock,
                const std::stop_token& stop, Clock::time_point until, const Ready& ready) {
  if (ready() || stop.stop_requested() || timer.now() >= until) return ready();
  lock.unlock();
  {
    const Timer::Alarm alarm = timer.at(until, [&changed, mutex = lock.mutex()] {
      const std::lock_guard guard(*mutex);
      changed.notify_all();
    });
    lock.lock();
    changed.wait(lock, stop, [&] { return ready() || timer.now() >= until; });
    lock.unlock();
  }
  lock.lock();
  return ready();
}

}  // namespace orrery
