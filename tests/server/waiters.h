#pragma once

#include <gtest/gtest.h>

#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/scheduler/admission.h"
#include "tests/support/eventually.h"

namespace orrery::test {

using TurnOrder = std::vector<std::string>;

inline const std::stop_token kNever;

// Requests that wait for admission, each on its own thread. Records the order of admission.
class Waiters {
 public:
  explicit Waiters(Admission& admission) : admission_(admission) {}
  ~Waiters() { join(); }

  // Starts a request and returns once it waits, is admitted or is rejected.
  void add(const std::string& name, const SlotRequest& demand) {
    const auto settled = [&] { return admission_.waiting() + order().size(); };
    const auto before = settled();
    threads_.emplace_back([this, name, demand] { wait(name, demand); });
    EXPECT_TRUE(eventually([&] { return settled() != before; }));
  }
  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  TurnOrder order() {
    const std::lock_guard lock(mutex_);
    return order_;
  }
  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    order_.push_back(what);
  }

 private:
  void wait(const std::string& name, const SlotRequest& demand) {
    try {
      const auto ticket = admission_.enter(demand, kNever);
      note(name);
    } catch (const ClientLimitExceeded&) {
      note(name + " 429");
    } catch (const Busy&) {
      note(name + " 503");
    }
  }

  Admission& admission_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  TurnOrder order_;
};

inline SlotRequest demand(const std::string& client, double cost = 10,
                          Priority priority = Priority::interactive) {
  return {priority, client, cost};
}

}  // namespace orrery::test
