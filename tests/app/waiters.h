#pragma once

#include <gtest/gtest.h>

#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/app/admission.h"
#include "tests/support/eventually.h"

namespace orrery::test {

using TurnOrder = std::vector<std::string>;

inline const std::stop_token kNever;

// People who wait for their turn, each on a thread, and the order in which they got it.
class Waiters {
 public:
  explicit Waiters(Admission& admission) : admission_(admission) {}
  ~Waiters() { join(); }

  // Returns once `name` waits, or was turned away.
  void add(const std::string& name, const Demand& demand) {
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
  void wait(const std::string& name, const Demand& demand) {
    try {
      const auto ticket = admission_.enter(demand, kNever);
      note(name);
    } catch (const ClientBusy&) {
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

inline Demand demand(const std::string& client, double cost = 10, Lane lane = Lane::interactive) {
  return {lane, client, cost};
}

}  // namespace orrery::test
