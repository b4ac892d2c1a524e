#include "server/app/pipeline.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace orrery {
namespace {

struct Rendered {
  std::int64_t number;
  RenderResult result;
  double render_ms;
};

// Hands one thing at a time from one thread to another.
class Handoff {
 public:
  // Waits until the last thing was taken. False if nothing will be taken any more.
  bool put(Rendered&& rendered) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !slot_ || closed_; });
    if (closed_) return false;
    slot_.emplace(std::move(rendered));
    changed_.notify_all();
    return true;
  }

  // Waits for a thing. None once it is closed and empty.
  std::optional<Rendered> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return slot_ || closed_; });
    std::optional<Rendered> taken = std::move(slot_);
    slot_.reset();
    changed_.notify_all();
    return taken;
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Rendered> slot_;
  bool closed_ = false;
};

// Closes the handoff and waits for the thread at the other end, however the scope is left.
class Encoding {
 public:
  Encoding(Handoff& handoff, std::function<void()> work)
      : handoff_(handoff), thread_([this, work = std::move(work)] {
          try {
            work();
          } catch (...) {
            error_ = std::current_exception();
          }
          handoff_.close();
        }) {}
  ~Encoding() { join(); }

  void finish() {
    join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void join() {
    handoff_.close();
    if (thread_.joinable()) thread_.join();
  }

  Handoff& handoff_;
  std::exception_ptr error_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace

void Pipeline::run() const {
  Handoff handoff;
  Encoding encoding(handoff, [&] {
    while (auto rendered = handoff.take())
      if (!deliver(rendered->number, encode_frame(std::move(rendered->result), rendered->render_ms, encode)))
        return;
  });
  while (const auto number = next()) {
    const auto start = Clock::now();
    RenderResult result = render(*number);
    if (!handoff.put({*number, std::move(result), milliseconds_since(start)})) break;
  }
  encoding.finish();
}

}  // namespace orrery
