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
#include "server/app/admission.h"
#include "server/app/lru.h"
#include "server/app/watch.h"
#include "server/http/handler_slots.h"

namespace orrery {

// Values made lately, by key, and those being made: what several ask for at one time is made once. A value
// is kept if it takes at most `largest` bytes, of at most `most_bytes` of all, in the share of the client
// that it was made for (see FairShares); std::size_t held_bytes(const Value&) tells how many. Safe from any
// thread.
template <class Value>
class SingleFlight {
 public:
  using ValuePtr = std::shared_ptr<const Value>;
  // Makes a value; a stop request says that nobody wants it any more.
  using Make = std::function<Value(const std::stop_token&)>;
  // Who asks for a value, and is one of `sharers` until it has it or is gone.
  struct Client {
    std::stop_token gone;
    std::string name = {};
    std::shared_ptr<Sharers> sharers = {};  // of all who ask for the value; null: they are not told
    Admission* admission = nullptr;         // of the sharers, if there are any
  };

  explicit SingleFlight(std::size_t most_bytes) : SingleFlight(most_bytes, most_bytes) {}
  SingleFlight(std::size_t most_bytes, std::size_t largest)
      : kept_(most_bytes, std::chrono::minutes(5)), largest_(largest) {}

  struct Found {
    ValuePtr value;
    bool made_here;  // for this caller; or else it was kept, or made for another
  };
  // The value called `key`. Where there is none, calls `make` on this thread, with a token that is stopped
  // once neither this caller nor others who came meanwhile wait any more. Throws what `make` throws, also for
  // those others, except that Busy, Cancelled and TimedOut concern the maker alone: one of the others then
  // makes it. Throws Cancelled once the client is gone.
  Found get(const std::string& key, const Client& client, const Make& make) {
    for (;;) {
      std::unique_lock lock(mutex_);
      if (const auto kept = kept_.find(key)) return {*kept, false};
      std::optional<Admission::Sharing> sharing;
      if (client.sharers) sharing.emplace(*client.admission, client.sharers, client.name);
      const auto known = under_way_.find(key);
      const bool first = known == under_way_.end();
      const WorkPtr work =
          first ? under_way_.emplace(key, std::make_shared<Work>()).first->second : known->second;
      ++work->waiting;
      lock.unlock();
      const std::stop_callback leaves(client.gone, [this, &work, &sharing] {
        sharing.reset();
        leave(*work);
      });
      if (first) return make_for_all(key, client.name, work, make);
      ValuePtr value;
      std::exception_ptr error;
      {  // ends before `leaves` goes, which may be waiting for the mutex
        const HandlerSlots::Wait wait;
        std::unique_lock again(mutex_);
        work->changed.wait(again, client.gone, [&] { return work->done; });
        value = work->value;
        error = work->error;
      }
      if (value) return {value, false};
      if (error) std::rethrow_exception(error);
      if (client.gone.stop_requested()) throw Cancelled("the client has gone");
    }
  }

  // The value called `key`, if it is kept.
  ValuePtr find(const std::string& key) {
    const auto kept = kept_.find(key);
    return kept ? *kept : nullptr;
  }
  // Keeps a value that was made elsewhere for the client, as get() would.
  void keep(const std::string& key, const std::string& client, const ValuePtr& value) {
    constexpr std::size_t kBeside = 4096;  // what the allocator adds to a large block, and the entries here
    const std::size_t bytes = kBeside + key.size() + held_bytes(*value);
    if (bytes <= largest_) kept_.add(key, client, bytes, [&] { return value; });
  }

  std::size_t bytes() const { return kept_.bytes(); }
  std::uint64_t evictions() const { return kept_.evictions(); }
  std::size_t largest() const { return largest_; }
  // How many wait for the value called `key`, which is being made, with the one who makes it.
  int waiting(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto work = under_way_.find(key);
    return work == under_way_.end() ? 0 : work->second->waiting;
  }

 private:
  struct Work {
    int waiting = 0;                // how many want it
    std::stop_source nobody_waits;  // requested once none of them is left
    bool done = false;
    ValuePtr value;            // once done, unless it failed
    std::exception_ptr error;  // likewise; none: somebody else has to make it
    std::condition_variable_any changed;
  };
  using WorkPtr = std::shared_ptr<Work>;

  void leave(Work& work) {
    {
      const std::lock_guard lock(mutex_);
      if (--work.waiting > 0) return;
    }
    work.nobody_waits.request_stop();
  }

  Found make_for_all(const std::string& key, const std::string& client, const WorkPtr& work,
                     const Make& make) {
    std::exception_ptr error;
    bool theirs = false;  // whether the error concerns the others
    ValuePtr value;
    try {
      value = std::make_shared<const Value>(make(work->nobody_waits.get_token()));
      keep(key, client, value);
    } catch (const Busy&) {
      error = std::current_exception();
    } catch (const Cancelled&) {  // another may have come at the last moment
      error = std::current_exception();
    } catch (const TimedOut&) {  // it came first, and others have more time
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
  std::map<std::string, WorkPtr> under_way_;  // guarded by mutex_, and what it points at
};

}  // namespace orrery
