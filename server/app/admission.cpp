#include "server/app/admission.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace orrery {
namespace {

constexpr double kRaysAByte = 1;        // of JSON or of a mesh: measured between 0.5 and 2
constexpr double kExpectedRate = 10e6;  // rays a second, before anything was measured
constexpr double kMemory_s = 10;        // seconds of work after which a measurement has faded to 1/e

std::string whole(double rays) {
  char text[32];
  std::snprintf(text, sizeof text, rays < 1e15 ? "%.0f" : "%.3g", rays);
  return text;
}

std::string in_millions(double rays) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g million", rays / 1e6);
  return text;
}

}  // namespace

TooManyRays::TooManyRays(double expected, double most)
    : InputError("", "the picture is expected to take " + whole(expected) +
                         " rays, and one request may ask for " + whole(most) +
                         " (request_rays); a job takes longer work: POST /v1/jobs") {}

double cost_of_reading(std::size_t bytes) { return kLeastCost + kRaysAByte * static_cast<double>(bytes); }

void Quota::require_one_more(int all, int own) const {
  if (all >= most)
    throw OverLimit(std::to_string(all) + " " + what + " already (" + limit + ")", retry_s, limit);
  if (own >= std::max(1, most / 2))
    throw ClientBusy(std::to_string(own) + " " + what +
                         " already that you asked for, which is half of all (" + limit + ")",
                     retry_s, limit);
}

int Admission::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}
int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::count_if(queue_.begin(), queue_.end(),
                                        [](const Waiting& w) { return w.state == Waiting::waits; }));
}
bool Admission::full() const {
  const std::lock_guard lock(mutex_);
  return running_ >= limits_.running && !fits(Lane::interactive, kLeastCost);
}

Admission::Ticket Admission::enter(const Demand& demand, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (!place_free(demand.lane)) make_room(demand);
  return wait_for_turn(lock, demand, true, stop);
}

Admission::Ticket Admission::enter_again(const Demand& demand, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  return wait_for_turn(lock, demand, false, stop);
}

Admission::Ticket Admission::wait_for_turn(std::unique_lock<std::mutex>& lock, const Demand& demand,
                                           bool may_be_dropped, const std::stop_token& stop) {
  const auto asked = timer_.now();
  const auto place = queue_.emplace(queue_.end(), demand, may_be_dropped, virtual_finish(demand));
  start_next();
  place->changed.wait(lock, stop, [&] { return place->state != Waiting::waits; });
  const auto state = place->state;
  queue_.erase(place);
  if (state == Waiting::starts) {  // who gives up finds it soon
    waits_[static_cast<int>(demand.lane)].Observe(
        std::chrono::duration<double>(timer_.now() - asked).count());
    return Ticket(*this, demand.lane, demand.cost);
  }
  start_next();
  if (state == Waiting::waits) throw Cancelled();
  throw ClientBusy("Others wait for their turn, and you had asked for more than they (queue_rays)",
                   retry_after_s(demand.lane), "queue_rays");
}

void Admission::start_next() {
  for (auto it = next(); it != queue_.end(); it = next()) {
    it->state = Waiting::starts;
    virtual_time_[static_cast<int>(it->demand.lane)] = it->finish;
    if (running_++ == 0) measured_ = timer_.now();
    if (it->demand.lane == Lane::batch) ++running_batch_;
    latest_ = it->demand.lane;
    it->changed.notify_one();
  }
}

void Admission::leave(Lane lane, double cost) {
  const std::lock_guard lock(mutex_);
  measure(cost);
  --running_;
  if (lane == Lane::batch) --running_batch_;
  start_next();
}

bool Admission::place_free(Lane lane) const {
  if (running_ >= limits_.running) return false;
  return lane == Lane::interactive || running_batch_ < std::max(1, limits_.running / 2);
}

Admission::Queue::iterator Admission::next() {
  auto best = queue_.end();
  const bool batch_starves = running_batch_ == 0 && latest_ != Lane::batch;
  const auto rank = [&](const Waiting& w) {
    const bool first = batch_starves == (w.demand.lane == Lane::batch);
    return std::pair(first ? 0 : 1, w.finish);
  };
  for (auto it = queue_.begin(); it != queue_.end(); ++it) {
    if (it->state != Waiting::waits || !place_free(it->demand.lane)) continue;
    if (best == queue_.end() || rank(*it) < rank(*best)) best = it;
  }
  return best;
}

double Admission::virtual_finish(const Demand& demand) const {
  double start = virtual_time_[static_cast<int>(demand.lane)];
  for (const Waiting& w : queue_)
    if (w.demand.lane == demand.lane && w.demand.client == demand.client) start = std::max(start, w.finish);
  return start + demand.cost;
}

double Admission::waiting_cost(Lane lane, const std::string* client) const {
  double sum = 0;
  for (const Waiting& w : queue_)
    if (w.state == Waiting::waits && w.may_be_dropped && w.demand.lane == lane &&
        (!client || w.demand.client == *client))
      sum += w.demand.cost;
  return sum;
}

bool Admission::fits(Lane lane, double cost) const {
  const double waiting = waiting_cost(lane);
  return waiting == 0 || waiting + cost <= limits_.queue_rays;
}

Admission::Queue::iterator Admission::newest_of_greediest(Lane lane) {
  const auto counts = [&](const Waiting& w) {
    return w.may_be_dropped && w.state == Waiting::waits && w.demand.lane == lane;
  };
  std::map<std::string, double> costs;
  for (const Waiting& w : queue_)
    if (counts(w)) costs[w.demand.client] += w.demand.cost;
  auto newest = queue_.end();
  for (auto it = queue_.begin(); it != queue_.end(); ++it)
    if (counts(*it) && (newest == queue_.end() || costs[it->demand.client] >= costs[newest->demand.client]))
      newest = it;
  return newest;
}

void Admission::make_room(const Demand& demand) {
  const Lane lane = demand.lane;
  while (!fits(lane, demand.cost)) {
    const auto greediest = newest_of_greediest(lane);
    const double own = waiting_cost(lane, &demand.client) + demand.cost;
    if (greediest->demand.client == demand.client || own >= waiting_cost(lane, &greediest->demand.client)) {
      const double all = waiting_cost(lane), mine = waiting_cost(lane, &demand.client);
      const std::string told = "Work of " + in_millions(all) + " rays waits already, at most " +
                               in_millions(limits_.queue_rays) + " may (queue_rays)";
      if (mine > 0 && mine < all)
        throw ClientBusy(told + ", much of it yours", retry_after_s(lane), "queue_rays");
      throw OverLimit(told, retry_after_s(lane), "queue_rays");
    }
    greediest->state = Waiting::dropped;
    greediest->changed.notify_one();
  }
}

void Admission::measure(double cost) {
  const auto now = timer_.now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(measured_, now)).count();
  if (cost == 0) return;  // it was broken off: nobody knows how much of it was done
  const double faded = std::exp(-seconds / kMemory_s);
  done_rays_ = done_rays_ * faded + cost;
  busy_s_ = busy_s_ * faded + seconds;
}

double Admission::retry_after_s(Lane lane) const {
  const double rate = busy_s_ > 0 ? done_rays_ / busy_s_ : kExpectedRate;
  return std::clamp(waiting_cost(lane) / rate, 1.0, 30.0);
}

}  // namespace orrery
