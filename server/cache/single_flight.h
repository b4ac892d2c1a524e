#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "core/base/error.h"
#include "server/base/lru.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/handler_slots.h"
#include "server/scheduler/watch.h"

namespace orrery {

// Cache that computes a value only once for concurrent requests with the same key. Stores values of at most
// `largest` bytes, and at most `max_bytes` in total. A value counts for the client that it was made for; see
// FairShares. std::size_t held_bytes(const Value&) must return the size of a value. Thread-safe.
template <class Value>
class SingleFlight {
 public:
  using ValuePtr = std::shared_ptr<const Value>;
  // Computes a value. The token is stopped once no caller waits for the value.
  using Make = std::function<Value(const std::stop_token&)>;
  // Caller, which is one of `subscribers` until it has the value or disconnects.
  struct Client {
    std::stop_token gone;
    std::string name = {};
    std::shared_ptr<Subscribers> subscribers = {};  // clients that wait for the value; null: not tracked
    Admission* admission = nullptr;                 // guards `subscribers`, if any
  };

  explicit SingleFlight(std::size_t max_bytes) : SingleFlight(max_bytes, max_bytes) {}
  SingleFlight(std::size_t max_bytes, std::size_t largest)
      : kept_(max_bytes, std::chrono::minutes(5)), largest_(largest) {}

  struct LookupResult {
    ValuePtr value;
    bool made_here;  // by this call, neither cached nor made by another
  };
  // Returns the value of `key`. If the value is neither cached nor in progress, calls `make` on this thread.
  // The token is stopped once no caller waits. Throws the error of `make`, also to the waiting callers. Busy,
  // Cancelled and TimedOut are thrown only to the caller of `make`, and a waiting caller then computes the
  // value. Throws Cancelled once the client disconnects.
  LookupResult get(const std::string& key, const Client& client, const Make& make) {
    for (;;) {
      std::unique_lock lock(mutex_);
      if (const auto kept = kept_.find(key)) return {*kept, false};
      std::optional<Admission::Subscription> sharing;
      if (client.subscribers) sharing.emplace(*client.admission, client.subscribers, client.name);
      const auto known = under_way_.find(key);
      const bool first = known == under_way_.end();
      const InFlightPtr work =
          first ? under_way_.emplace(key, std::make_shared<InFlight>()).first->second : known->second;
      ++work->waiting;
      lock.unlock();
      const std::stop_callback leaves(client.gone, [this, &work, &sharing] {
        sharing.reset();
        leave(*work);
      });
      if (first) return make_for_all(key, client.name, work, make);
      ValuePtr value;
      std::exception_ptr error;
      {  // unlocks before the end of `leaves`, whose callback may wait for mutex_
        const HandlerSlots::Wait wait;
        std::unique_lock again(mutex_);
        work->changed.wait(again, client.gone, [&] { return work->done; });
        value = work->value;
        error = work->error;
      }
      if (value) return {value, false};
      if (error) std::rethrow_exception(error);
      if (client.gone.stop_requested()) throw Cancelled("client disconnected");
    }
  }

  // Returns the value of `key` if it is cached, else null.
  ValuePtr find(const std::string& key) {
    const auto kept = kept_.find(key);
    return kept ? *kept : nullptr;
  }
  // Caches a value that was made elsewhere for the client, as get() would.
  void keep(const std::string& key, const std::string& client, const ValuePtr& value) {
    constexpr std::size_t kBeside = 4096;  // overhead of the allocator and of the entries, bytes
    const std::size_t bytes = kBeside + key.size() + held_bytes(*value);
    if (bytes <= largest_) kept_.add(key, client, bytes, [&] { return value; });
  }

  std::size_t bytes() const { return kept_.bytes(); }
  std::uint64_t evictions() const { return kept_.evictions(); }
  std::size_t largest() const { return largest_; }
  // Returns the number of callers waiting for a value in progress, including its maker.
  int waiting(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto work = under_way_.find(key);
    return work == under_way_.end() ? 0 : work->second->waiting;
  }

 private:
  struct InFlight {
    int waiting = 0;                // number of callers that want the value
    std::stop_source nobody_waits;  // requested once `waiting` is 0
    bool done = false;
    ValuePtr value;            // set once done, unless `make` failed
    std::exception_ptr error;  // set if the error concerns all callers
    std::condition_variable_any changed;
  };
  using InFlightPtr = std::shared_ptr<InFlight>;

  void leave(InFlight& work) {
    {
      const std::lock_guard lock(mutex_);
      if (--work.waiting > 0) return;
    }
    work.nobody_waits.request_stop();
  }

  LookupResult make_for_all(const std::string& key, const std::string& client, const InFlightPtr& work,
                            const Make& make) {
    std::exception_ptr error;
    bool theirs = false;  // the error concerns all callers
    ValuePtr value;
    try {
      value = std::make_shared<const Value>(make(work->nobody_waits.get_token()));
      keep(key, client, value);
    } catch (const Busy&) {
      error = std::current_exception();
    } catch (const Cancelled&) {  // a new caller may have joined meanwhile
      error = std::current_exception();
    } catch (const TimedOut&) {  // later callers have more time
      error = std::current_exception();
    } catch (...) {
      error = std::current_exception();
      theirs = true;
    }
    {
      const std::lock_guard lock(mutex_);
      under_way_.erase(key);
      work->done = true;
      work->value = value;
      if (theirs) work->error = error;
      work->changed.notify_all();
    }
    if (error) std::rethrow_exception(error);
    return {value, true};
  }

  Lru<ValuePtr> kept_;
  const std::size_t largest_;
  mutable std::mutex mutex_;
  std::map<std::string, InFlightPtr> under_way_;  // guarded by mutex_, including its elements
};

}  // namespace orrery
