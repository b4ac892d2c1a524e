#include "server/rendering/pipeline.h"

#include <condition_variable>
#include <exception>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "core/base/clock.h"

namespace orrery {
namespace {

constexpr std::int64_t kMaxFrames = 3;  // maximum frames in memory: one being rendered, two being encoded

// Queue of frames between rendering and delivery. Frames are encoded in parallel and delivered in order.
class Line {
 public:
  explicit Line(const Pipeline& pipeline)
      : pipeline_(pipeline), memory_(pipeline.memory ? pipeline.memory->open_another() : nullptr) {}
  ~Line() { wait_until_empty(); }

  // Waits until another frame may be rendered. Returns false if an earlier frame failed.
  bool wait_for_room() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return entered_ - left_ < kMaxFrames; });
    return !error_;
  }

  void enter(std::int64_t number, RenderResult&& rendered, double render_ms) {
    const std::int64_t place = entered_;  // only this thread changes entered_
    const auto shared = std::make_shared<RenderResult>(std::move(rendered));
    pipeline_.pool.enqueue(pipeline_.background, [this, place, number, shared, render_ms] {
      std::packaged_task<Frame()> encoding([&] { return encode(*shared, render_ms); });
      encoding();
      leave(place, number, encoding.get_future());
    });
    const std::lock_guard lock(mutex_);
    ++entered_;
  }

  // Waits for all frames. Throws the error of the first one that failed.
  void finish() {
    wait_until_empty();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  // Encodes a frame. If memory is short, a frame below 32 MiB is still kept, and the next render waits for
  // memory.
  Frame encode(const RenderResult& rendered, double render_ms) const {
    const TaskScope scope({nullptr, &pipeline_.stop});
    const auto start = Clock::now();
    Frame frame{.bytes = pipeline_.encode(rendered.film),
                .stats = rendered.stats,
                .certificate = rendered.certificate,
                .render_ms = render_ms};
    frame.encode_ms = milliseconds_since(start);
    if (!memory_) return frame;
    frame.bytes.shrink_to_fit();
    const auto charge = [&] { return MemoryCharge(frame.bytes.capacity()); };
    frame.charge = memory_->run(pipeline_.stop, charge);
    memory_->settle(0);  // charges all frames, even over the limit
    return frame;
  }

  void wait_until_empty() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return entered_ == left_; });
  }

  void leave(std::int64_t place, std::int64_t number, std::future<Frame> frame) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(place, std::pair(number, std::move(frame)));
    for (; !waiting_.empty() && waiting_.begin()->first == left_; ++left_, waiting_.erase(waiting_.begin())) {
      auto& [first, encoded] = waiting_.begin()->second;
      if (!error_) try {
          pipeline_.deliver(first, encoded.get());
        } catch (...) {
          error_ = std::current_exception();
        }
    }
    changed_.notify_all();
  }

  const Pipeline& pipeline_;
  const std::shared_ptr<WorkAccount> memory_;  // account of encoded frames; films have another one
  std::mutex mutex_;                           // guards the members below
  std::condition_variable changed_;
  std::int64_t entered_ = 0, left_ = 0;
  // Numbers and encoded frames by position, until all earlier frames are delivered.
  std::map<std::int64_t, std::pair<std::int64_t, std::future<Frame>>> waiting_;
  std::exception_ptr error_;
};

}  // namespace

void Pipeline::run() const {
  Line line(*this);
  while (line.wait_for_room()) {
    const auto number = next();
    if (!number) break;
    const auto start = Clock::now();
    RenderResult result = render(*number);
    line.enter(*number, std::move(result), milliseconds_since(start));
  }
  line.finish();
}

}  // namespace orrery
