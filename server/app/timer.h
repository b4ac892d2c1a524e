#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "core/base/clock.h"

namespace orrery {

// The time, and what is to be done at some time. An interface so that tests can drive the time by hand. Safe
// from any thread.
class Timer {
 public:
  using Action = std::function<void()>;

  Timer() = default;
  virtual ~Timer() = default;
  Timer(const Timer&) = delete;

  virtual Clock::time_point now() const = 0;

  // An action that is to be done. The timer must outlive it. Once it is destroyed the action is neither done
  // nor being done, except where the action itself destroys it.
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

  // Calls `action` at that time, or at once on the calling thread if it has come already. Actions are called
  // one at a time and must be short; what they lock must not be locked while their alarm is destroyed.
  [[nodiscard]] Alarm at(Clock::time_point when, Action action);

 protected:
  using Lock = std::unique_lock<std::mutex>;

  // Does the first thing that is due by `time`. False if there is none. REQUIRES: `lock` is held, of mutex();
  // it is released meanwhile.
  bool do_first(Lock& lock, Clock::time_point time);
  // When the next alarm is due. REQUIRES: mutex() is held.
  Clock::time_point next_due() const;
  std::mutex& mutex() const { return mutex_; }
  // Called with mutex() held after an alarm was added that is due before all others.
  virtual void next_changed() = 0;

 private:
  using Key = std::pair<Clock::time_point, std::uint64_t>;
  void cancel(const Key& key);

  mutable std::mutex mutex_;  // guards all below
  std::condition_variable done_;
  std::map<Key, Action> alarms_;
  std::uint64_t last_number_ = 0, being_done_ = 0;  // numbers of alarms, from 1
  std::thread::id doer_;                            // who does `being_done_`
};

// By the machine's steady clock; a thread of its own does what is due.
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

// Waits on `changed` until ready(), a stop is requested or `until` has come; returns ready(), which is called
// with the mutex held. REQUIRES: `lock` holds its mutex, which guards what ready() reads; it is released
// while waiting.
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
