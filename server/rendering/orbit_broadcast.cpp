#include "server/rendering/orbit_broadcast.h"

#include <algorithm>

#include "server/rendering/pipeline.h"
#include "server/scheduler/watch.h"

namespace orrery {
namespace {

constexpr std::int64_t kAhead = 3;        // maximum frames rendered ahead of delivery
constexpr double kLongestPeriod_s = 1e6;  // a clock overflows after 292 years

}  // namespace

OrbitBroadcast::OrbitBroadcast(OrbitSpec spec, const RenderServices& services)
    : spec_(std::move(spec)), services_(services), memory_(services.memory.open(spec_.client)) {}

OrbitBroadcast::~OrbitBroadcast() {
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<OrbitBroadcast::Viewer> OrbitBroadcast::join(const std::shared_ptr<OrbitBroadcast>& cast,
                                                             const std::string& client) {
  const std::lock_guard lock(cast->mutex_);
  if (cast->closed_) return nullptr;
  const std::int64_t begin = cast->delivered_ - (cast->latest_ ? 1 : 0);
  const auto mailbox = cast->mailboxes_.insert(cast->mailboxes_.end(), {.client = client,
                                                                        .begin = begin,
                                                                        .end = begin + cast->spec_.frames,
                                                                        .frame = cast->latest_,
                                                                        .number = begin});
  if (!cast->thread_.joinable()) {
    cast->start_ = cast->services_.timer.now();
    cast->thread_ = std::thread([c = cast.get()] { c->run(); });
  }
  cast->changed_.notify_all();
  return std::unique_ptr<Viewer>(new Viewer(cast, mailbox, client));
}

bool OrbitBroadcast::is_watched_by(const std::string& client) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(mailboxes_.begin(), mailboxes_.end(),
                     [&](const Mailbox& mailbox) { return mailbox.client == client; });
}

void OrbitBroadcast::run() {
  const Pipeline pipeline{
      .pool = services_.pool,
      .background = false,
      .next = [this] { return next(); },
      .render = [this](std::int64_t n) { return render(n); },
      .encode = [](const Film& film) { return encode_film(film, FileFormat::png, kFrameOfStream); },
      .stop = nobody_watches_.get_token(),
      .memory = memory_.get(),
      .deliver = [this](std::int64_t n, Frame&& frame) { deliver(n, std::move(frame)); }};
  std::exception_ptr failure;
  try {
    pipeline.run();
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  failure_ = failure;
  closed_ = over_ = true;
  changed_.notify_all();
}

bool OrbitBroadcast::anyone_wants(std::int64_t number) const {
  return std::any_of(mailboxes_.begin(), mailboxes_.end(), [&](const Mailbox& m) { return m.wants(number); });
}

bool OrbitBroadcast::anyone_free(std::int64_t number) const {
  return std::any_of(mailboxes_.begin(), mailboxes_.end(),
                     [&](const Mailbox& m) { return m.wants(number) && !m.frame; });
}

bool OrbitBroadcast::at_end(const Mailbox& mailbox) const {
  return delivered_ >= mailbox.end || (over_ && finished_.empty());
}

std::optional<std::int64_t> OrbitBroadcast::next() {
  std::unique_lock lock(mutex_);
  const auto period =
      std::chrono::duration<double>(spec_.fps > 0 ? std::min(1 / spec_.fps, kLongestPeriod_s) : 0);
  const auto due = [&](std::int64_t n) {
    return start_ + std::chrono::duration_cast<Clock::duration>(period * static_cast<double>(n));
  };
  const auto over = [&] { return !anyone_wants(next_); };
  const std::stop_token& ends = services_.draining;
  bool waited = false;
  if (spec_.fps == 0) {
    changed_.wait(lock, ends, [&] { return over() || next_ - delivered_ < kAhead; });
  } else {
    wait_until(services_.timer, changed_, lock, ends, due(next_), over);
    waited = !over() && !anyone_free(next_);
    changed_.wait(lock, ends, [&] { return over() || anyone_free(next_); });
  }
  if (over() || ends.stop_requested()) {
    closed_ = true;
    return std::nullopt;
  }
  if (spec_.fps > 0) {
    const auto now = services_.timer.now();
    const auto on_time = static_cast<std::int64_t>((now - start_) / period);
    std::int64_t end = 0;
    for (const Mailbox& m : mailboxes_) end = std::max(end, m.end);
    if (waited)
      next_ = std::clamp(on_time, next_, end - 1);
    else if (on_time > next_)
      start_ += now - due(next_);
  }
  return next_++;
}

RenderResult OrbitBroadcast::render(std::int64_t number) {
  const WorkCancellation watch(nobody_watches_.get_token(), services_.ends, services_.timer,
                               services_.timer.now(), {services_.request_seconds, "request_seconds"});
  return watch.run([&](const std::stop_token& stop) {
    const RenderOrder order = make_order(spec_.scene, spec_.path.at(number % spec_.frames), FileFormat::png,
                                         {spec_.client, stop, subscribers_});
    return services_.render_next(order, *memory_, false, {.stop = stop});
  });
}

void OrbitBroadcast::deliver(std::int64_t number, Frame&& picture) {
  const int frame = static_cast<int>(number % spec_.frames);
  const RenderRequest request = spec_.path.at(frame);
  const auto shared = std::make_shared<const OrbitFrame>(OrbitFrame{.frame = frame,
                                                                    .orbit = orbit_of(request),
                                                                    .time = *request.time,
                                                                    .width = *request.width,
                                                                    .height = *request.height,
                                                                    .picture = std::move(picture)});
  const std::lock_guard lock(mutex_);
  finished_.emplace_back(number, shared);
  post();
}

void OrbitBroadcast::post() {
  for (; !finished_.empty(); finished_.pop_front()) {
    const auto& [number, frame] = finished_.front();
    if (spec_.fps == 0 && anyone_wants(number) && !anyone_free(number)) break;
    for (Mailbox& mailbox : mailboxes_) {
      if (!mailbox.wants(number)) continue;
      mailbox.frame = frame;
      mailbox.number = number;
    }
    delivered_ = number + 1;
    latest_ = frame;
  }
  changed_.notify_all();
}

OrbitBroadcast::Viewer::~Viewer() {
  {
    const std::lock_guard lock(cast_->mutex_);
    cast_->mailboxes_.erase(mailbox_);
    cast_->post();
    if (!cast_->mailboxes_.empty()) return;
    cast_->closed_ = true;
  }
  cast_->nobody_watches_.request_stop();
}

std::shared_ptr<const OrbitFrame> OrbitBroadcast::Viewer::next(const std::stop_token& gone) {
  std::unique_lock lock(cast_->mutex_);
  cast_->changed_.wait(lock, gone, [&] { return mailbox_->frame || cast_->at_end(*mailbox_); });
  if (!mailbox_->frame) {
    const bool cut_short = !gone.stop_requested() && !cast_->services_.ends.stop_requested();
    if (cut_short && cast_->failure_) std::rethrow_exception(cast_->failure_);
    return nullptr;
  }
  const auto frame = std::move(mailbox_->frame);
  mailbox_->frame = nullptr;
  mailbox_->fetched += 1;
  skipped_ = mailbox_->number - mailbox_->begin + 1 - mailbox_->fetched;
  cast_->post();
  at_end_ = !mailbox_->frame && cast_->at_end(*mailbox_);
  return frame;
}

}  // namespace orrery
