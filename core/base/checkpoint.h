#pragma once

#include <stop_token>
#include <utility>

namespace orrery {

// The right to work on a thread that others wait for as well.
class Turn {
 public:
  // Returns when it is this work's turn again: at once as long as its turn has not lasted long, or nobody
  // waits.
  virtual void give_way() = 0;

 protected:
  ~Turn() = default;
};

// What long work asks every few milliseconds.
class Checkpoint {
 public:
  Checkpoint() = default;
  // `turn`, if there is one, outlives it.
  Checkpoint(std::stop_token stop, Turn* turn = nullptr) : stop_(std::move(stop)), turn_(turn) {}

  // Lets others go first if they have waited long enough. False: the work is to end.
  bool go_on() const {
    if (turn_) turn_->give_way();
    return !stop_.stop_requested();
  }

 private:
  std::stop_token stop_;
  Turn* turn_ = nullptr;
};

}  // namespace orrery
