#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "server/http/over_limit.h"

namespace orrery {

// Bytes that many may take from together. Safe from any thread.
class Budget {
 public:
  // `name`: of the limit, in /v1/limits; `takers`: what errors call those who take, at the start of a
  // sentence.
  Budget(std::size_t most, const char* name, const char* takers)
      : most_(most), name_(name), takers_(takers) {}

  // Bytes taken, given back with the object.
  class Share {
   public:
    explicit Share(Budget& from) : from_(from) {}
    ~Share() { from_.taken_ -= bytes_; }
    Share(const Share&) = delete;
    // Takes what it has not yet of so many bytes. Throws OverLimit if there are not so many left.
    void grow(std::size_t bytes) {
      if (bytes <= bytes_) return;
      from_.take_more(bytes - bytes_);
      bytes_ = bytes;
    }

   private:
    Budget& from_;
    std::size_t bytes_ = 0;
  };

 private:
  void take_more(std::size_t bytes) {
    constexpr double kRetry_s = 2;
    std::size_t taken = taken_;
    do {
      if (bytes > most_ - taken)
        throw OverLimit(std::string(takers_) + " take " + std::to_string(taken) +
                            " bytes already, of at most " + std::to_string(most_) + " (" + name_ + "), and " +
                            std::to_string(bytes) + " more are needed",
                        kRetry_s, name_);
    } while (!taken_.compare_exchange_weak(taken, taken + bytes));
  }

  const std::size_t most_;
  const char *const name_, *const takers_;
  std::atomic<std::size_t> taken_{0};
};

}  // namespace orrery
