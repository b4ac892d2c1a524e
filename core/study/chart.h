#pragma once

#include <string>
#include <vector>

#include "core/study/difference.h"

namespace orrery {

// One way to make the picture.
struct Configuration {
  std::string technique;
  int max_depth = 0;
  bool double_precision = false;
  int samples = 1;
};

// What a picture of some configuration cost, and how far it was off.
struct Measurement {
  Difference difference;  // from the reference
  double cpu_ms = 0;      // of all threads together, without building
  double rays = 0;        // traced
};

// Several pictures of one configuration, by different seeds.
struct Point {
  Configuration configuration;
  std::vector<Measurement> rounds;
  std::string accelerator;  // that the plan or the view chose
  bool on_front = false;    // no other is both as fast and as near, and better in one of the two

  double rmse() const;     // sqrt of the mean square error of all rounds
  double rmse_sd() const;  // standard deviation of the rounds' errors; 0 for one round
  double psnr_db() const;  // 10 log10 of 1 / mean square error of all rounds, cut to 0..1; may be infinite
  double cpu_ms() const;   // median of the rounds
  double rays() const;     // mean of the rounds
  // Mean of the rounds, whatever `value` takes from a Measurement.
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0;
    for (const Measurement& s : rounds) sum += value(s);
    return sum / static_cast<double>(rounds.size());
  }
};

// Speed against accuracy of one picture.
struct Chart {
  std::string scene_id, title;
  int width = 0, height = 0;
  Configuration reference;
  double reference_cpu_ms = 0;  // of one of the two
  // What the reference itself may be off, as an RMSE: half of that between two pictures with different seeds,
  // of which it is the mean. Smaller errors mean nothing.
  double reference_rmse = 0;
  std::vector<Point> points;  // by technique, depth, precision, samples

  double cheapest_ms() const;  // of the points
};

// Sets on_front: the points that are nearer, by more than 1 %, than all faster ones on it.
void mark_front(std::vector<Point>& points);

// "whitted 5, double": what a line of the chart joins.
std::string line_name(const Configuration& configuration);

// A drawing of 860 x 520: RMSE over CPU time as a multiple of the cheapest point's, both logarithmic.
std::string svg_of(const Chart& chart);

}  // namespace orrery
