#pragma once

#include <chrono>
#include <thread>

namespace orrery::test {

// Waits for what other threads or processes do: asks ready() until it is true. False if that takes longer
// than ten minutes: only what hangs does, on any machine.
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
