#include "core/study/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace orrery {
namespace {

template <class Value>
std::vector<double> values_of(const Point& point, const Value& value) {
  std::vector<double> all;
  for (const Measurement& s : point.rounds) all.push_back(value(s));
  return all;
}

double rmse_of(const Measurement& s) { return s.difference.rmse; }
double cpu_ms_of(const Measurement& s) { return s.cpu_ms; }

// Returns the 95 % confidence interval of the mean of non-negative values, clipped at 0, or nullopt for fewer
// than two values.
std::optional<Interval> interval_of(const std::vector<double>& values) {
  auto interval = mean_interval(values);
  if (interval) interval->low = std::max(0.0, interval->low);
  return interval;
}

}  // namespace

double Point::rmse() const {
  return std::sqrt(mean([](const Measurement& s) { return s.difference.rmse * s.difference.rmse; }));
}

double Point::rmse_sd() const {
  if (rounds.size() < 2) return 0;
  const double middle = mean(rmse_of);
  double squares = 0;
  for (const Measurement& s : rounds) squares += (s.difference.rmse - middle) * (s.difference.rmse - middle);
  return std::sqrt(squares / static_cast<double>(rounds.size() - 1));
}

double Point::psnr_db() const {
  return -10 * std::log10(mean([](const Measurement& s) { return s.difference.cut_mse; }));
}

double Point::cpu_ms() const { return mean(cpu_ms_of); }

double Point::rays() const {
  return mean([](const Measurement& s) { return s.rays; });
}

std::optional<Interval> Point::rmse_interval() const { return interval_of(values_of(*this, rmse_of)); }
std::optional<Interval> Point::cpu_ms_interval() const { return interval_of(values_of(*this, cpu_ms_of)); }

double Point::max_rmse() const {
  const auto interval = rmse_interval();
  return interval ? interval->high : rmse();
}

PictureSize narrowed(const PictureSize& size, int width) {
  return {width, std::max(1, static_cast<int>(std::lround(double(size.height) * width / size.width)))};
}

double Chart::cheapest_ms() const {
  double cheapest = std::numeric_limits<double>::infinity();
  for (const Point& p : points) cheapest = std::min(cheapest, p.cpu_ms());
  return cheapest;
}

std::vector<std::size_t> Chart::front() const {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].on_front()) all.push_back(i);
  std::stable_sort(all.begin(), all.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].cpu_ms() < points[b].cpu_ms(); });
  return all;
}

double Chart::full_seconds(double cpu_ms) const {
  const double pixels = double(size.width) * size.height, rendered = double(measured.width) * measured.height;
  return cpu_ms / 1000 * (pixels / rendered) / threads;
}

namespace {

// Returns the 95 % confidence interval of the mean of difference(a, b) over the common rounds of both points.
// With one common round, both ends are the difference of this round. REQUIRES: both points have a round.
template <class Difference>
Interval compared(const Point& a, const Point& b, const Difference& difference) {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::min(a.rounds.size(), b.rounds.size()); ++i)
    values.push_back(difference(a.rounds[i], b.rounds[i]));
  return mean_interval(values).value_or(Interval{values.front(), values.front()});
}

Interval extra_ms(const Point& point, const Point& other) {
  return compared(point, other,
                  [](const Measurement& a, const Measurement& b) { return a.cpu_ms - b.cpu_ms; });
}

// Returns the interval of the error of `point` minus 0.99 times the error of `other`. It is below 0 if the
// error of `point` is more than 1 % smaller.
Interval extra_rmse(const Point& point, const Point& other, double floor) {
  constexpr double kNearer = 0.99;
  return compared(point, other, [&](const Measurement& a, const Measurement& b) {
    return std::max(rmse_of(a), floor) - kNearer * std::max(rmse_of(b), floor);
  });
}

bool is_dominated(const Point& point, const Point& other, double floor) {
  return extra_ms(point, other).low > 0 && extra_rmse(point, other, floor).low >= 0;
}

// Returns whether `point` is slower and less accurate than `other`, with intervals that do not overlap. Uses
// all rounds of both points, not only the common ones.
bool is_apart(const Point& point, const Point& other) {
  const auto beyond = [](const std::optional<Interval>& worse, const std::optional<Interval>& better) {
    return worse && better && worse->low > better->high;
  };
  return beyond(point.rmse_interval(), other.rmse_interval()) &&
         beyond(point.cpu_ms_interval(), other.cpu_ms_interval());
}

bool is_better_in_one(const Point& point, const Point& other, double floor) {
  return extra_ms(point, other).high < 0 || extra_rmse(point, other, floor).high < 0;
}

}  // namespace

void mark_pareto_front(std::vector<Point>& points, double floor) {
  std::vector<Point*> by_time, front;
  for (Point& p : points) by_time.push_back(&p);
  std::stable_sort(by_time.begin(), by_time.end(), [](const Point* a, const Point* b) {
    return std::pair(a->cpu_ms(), a->rmse()) < std::pair(b->cpu_ms(), b->rmse());
  });
  for (Point* p : by_time) {
    p->pareto_status = ParetoStatus::dominated;
    const bool dominated =
        std::any_of(front.begin(), front.end(),
                    [&](const Point* q) { return is_dominated(*p, *q, floor); }) ||
        std::any_of(points.begin(), points.end(), [&](const Point& q) { return is_apart(*p, q); });
    if (!dominated) front.push_back(p);
  }
  for (Point* p : front) {
    const bool sure = std::all_of(front.begin(), front.end(),
                                  [&](const Point* q) { return p == q || is_better_in_one(*p, *q, floor); });
    p->pareto_status = sure ? ParetoStatus::front : ParetoStatus::undecided;
  }
}

std::vector<Recommendation> recommendations(const Chart& chart) {
  constexpr std::array kErrors{0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001};
  const std::vector<std::size_t> front = chart.front();
  std::vector<Recommendation> all;
  for (const double error : kErrors) {
    const auto found = std::find_if(front.begin(), front.end(),
                                    [&](std::size_t i) { return chart.points[i].max_rmse() < error; });
    if (found == front.end()) break;
    if (!all.empty() && all.back().point == *found) all.pop_back();
    all.push_back({error, *found});
  }
  return all;
}

std::string line_name(const Configuration& configuration) {
  return configuration.technique + " " + std::to_string(configuration.max_depth) +
         (configuration.double_precision ? ", double" : "");
}

}  // namespace orrery
