#include "core/study/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace orrery {

double Point::rmse() const {
  return std::sqrt(mean([](const Measurement& s) { return s.difference.rmse * s.difference.rmse; }));
}

double Point::rmse_sd() const {
  if (rounds.size() < 2) return 0;
  const double middle = mean([](const Measurement& s) { return s.difference.rmse; });
  double squares = 0;
  for (const Measurement& s : rounds) squares += (s.difference.rmse - middle) * (s.difference.rmse - middle);
  return std::sqrt(squares / static_cast<double>(rounds.size() - 1));
}

double Point::psnr_db() const {
  return -10 * std::log10(mean([](const Measurement& s) { return s.difference.cut_mse; }));
}

double Point::cpu_ms() const {
  std::vector<double> times;
  for (const Measurement& s : rounds) times.push_back(s.cpu_ms);
  std::sort(times.begin(), times.end());
  const std::size_t half = times.size() / 2;
  return times.size() % 2 == 1 ? times[half] : (times[half - 1] + times[half]) / 2;
}

double Point::rays() const {
  return mean([](const Measurement& s) { return s.rays; });
}

double Chart::cheapest_ms() const {
  double cheapest = std::numeric_limits<double>::infinity();
  for (const Point& p : points) cheapest = std::min(cheapest, p.cpu_ms());
  return cheapest;
}

void mark_front(std::vector<Point>& points) {
  constexpr double kNearer = 0.99;
  std::vector<Point*> by_time;
  for (Point& p : points) by_time.push_back(&p);
  std::stable_sort(by_time.begin(), by_time.end(), [](const Point* a, const Point* b) {
    return std::pair(a->cpu_ms(), a->rmse()) < std::pair(b->cpu_ms(), b->rmse());
  });
  double nearest = std::numeric_limits<double>::infinity();
  for (Point* p : by_time) {
    p->on_front = p->rmse() < nearest * kNearer;
    if (p->on_front) nearest = p->rmse();
  }
}

std::string line_name(const Configuration& configuration) {
  return configuration.technique + " " + std::to_string(configuration.max_depth) +
         (configuration.double_precision ? ", double" : "");
}

}  // namespace orrery
