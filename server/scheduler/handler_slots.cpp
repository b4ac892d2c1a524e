#include "server/scheduler/handler_slots.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace orrery {
namespace {

thread_local HandlerSlots::Handler* current = nullptr;

}  // namespace

HandlerSlots::Handler::Handler(HandlerSlots& slots, std::string client, std::stop_token gone,
                               WaitState& state)
    : slots_(slots), client_(std::move(client)), gone_(std::move(gone)), state_(state), outer_(current) {
  state_.begin_turn(WaitState::Kind::turn);
  acquire();
  state_.end();
  if (!has_slot_) throw Cancelled("client disconnected");
  current = this;
}

HandlerSlots::Handler::~Handler() {
  current = outer_;
  release();
}

void HandlerSlots::Handler::acquire() {
  if (has_slot_) return;
  has_slot_ = slots_.take(client_, gone_, has_begun_);
  has_begun_ = true;
  since_ = std::chrono::steady_clock::now();
}

void HandlerSlots::Handler::release() {
  if (std::exchange(has_slot_, false)) slots_.give_back();
}

HandlerSlots::Wait::Wait(WaitState::Kind kind)
    : handler_(current), shown_(handler_ && kind != WaitState::Kind::client) {
  if (handler_) handler_->release();
  if (shown_) handler_->state_.begin_turn(kind);
}

HandlerSlots::Wait::~Wait() {
  if (handler_ && !ended_) handler_->acquire();
  if (shown_ && !ended_) handler_->state_.end();
}

void HandlerSlots::Wait::end_without_slot() {
  if (shown_ && !ended_) handler_->state_.end();
  ended_ = true;
}

void HandlerSlots::resume() {
  if (current) current->acquire();
}

void HandlerSlots::Handler::yield() {
  constexpr std::chrono::milliseconds kSlice{5};  // time slice while other handlers wait
  if (current != this || !has_slot_ || slots_.waiting() == 0) return;
  if (std::chrono::steady_clock::now() - since_ < kSlice) return;
  release();
  acquire();
}

void HandlerSlots::yield() {
  if (current) current->yield();
}

bool HandlerSlots::take(const std::string& client, const std::stop_token& gone, bool goes_on) {
  std::unique_lock lock(mutex_);
  if (free_ > 0) {
    --free_;
    return true;
  }
  Waiter waiter;
  auto own =
      std::find_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.name == client; });
  if (own == clients_.end()) own = clients_.insert(clients_.end(), {client, {}});
  ++waiting_;
  own->waiters.insert(goes_on ? own->waiters.begin() : own->waiters.end(), &waiter);
  waiter.changed.wait(lock, gone, [&] { return waiter.granted; });
  if (!waiter.granted) remove(client, waiter);
  return waiter.granted;
}

void HandlerSlots::give_back() {
  const std::lock_guard lock(mutex_);
  if (clients_.empty()) {
    ++free_;
    return;
  }
  Client& client = clients_.front();
  Waiter& next = *client.waiters.front();
  client.waiters.pop_front();
  --waiting_;
  if (client.waiters.empty())
    clients_.pop_front();
  else
    clients_.splice(clients_.end(), clients_, clients_.begin());
  next.granted = true;
  next.changed.notify_one();
}

void HandlerSlots::remove(const std::string& client, Waiter& waiter) {
  const auto own =
      std::find_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.name == client; });
  std::erase(own->waiters, &waiter);
  --waiting_;
  if (own->waiters.empty()) clients_.erase(own);
}

}  // namespace orrery
