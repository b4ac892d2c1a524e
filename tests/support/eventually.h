#pragma once

#include <chrono>
#include <thread>

namespace orrery::test {

// Calls ready() every millisecond until it returns true. Returns false after ten minutes, which means that
// the program hangs.
template <class Ready>
bool eventually(const Ready& ready) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(10);
  while (!ready()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace orrery::test
