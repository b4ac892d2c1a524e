#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/render/certificate.h"
#include "core/study/difference.h"
#include "core/study/interval.h"

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
  double ssim = 1;        // likewise; see ssim()
  double cpu_ms = 0;      // of all threads together, without building
  double rays = 0;        // traced
};

// How a point stands to the others: nearer or faster than each; perhaps, as rounds differ too much to tell;
// beaten by one that is faster and no farther off.
enum class Standing { front, undecided, beaten };

// Several pictures of one configuration, by different seeds. The n-th rounds of all points share theirs.
struct Point {
  Configuration configuration;
  std::vector<Measurement> rounds;
  std::string accelerator;  // that the plan or the view chose
  // Queries of frame.png for the first round's picture: at the size that was asked, and at most
  // kPictureWidth wide.
  std::string plan, picture_plan;
  std::optional<Certificate> certificate = {};  // of the first round
  Standing standing = Standing::beaten;

  double rmse() const;     // sqrt of the mean square error of all rounds
  double rmse_sd() const;  // standard deviation of the rounds' errors; 0 for one round
  double psnr_db() const;  // 10 log10 of 1 / mean square error of all rounds, cut to 0..1; may be infinite
  double cpu_ms() const;   // mean of the rounds
  double rays() const;     // mean of the rounds
  // Of the means over the rounds; none of one round.
  std::optional<Interval> rmse_interval() const;
  std::optional<Interval> cpu_ms_interval() const;
  // What its error is at most: the interval's end, or what the only round had.
  double most_rmse() const;
  bool on_front() const { return standing != Standing::beaten; }
  // Mean of the rounds, whatever `value` takes from a Measurement.
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0;
    for (const Measurement& s : rounds) sum += value(s);
    return sum / static_cast<double>(rounds.size());
  }
};

inline constexpr int kPictureWidth = 320;  // pixels; of the pictures that a chart points to

struct PictureSize {
  int width = 0, height = 0;
};
// The same proportions, `width` wide. REQUIRES: 1 <= width <= size.width.
PictureSize narrowed(const PictureSize& size, int width);

// Speed against accuracy of one picture.
struct Chart {
  std::string scene_id, title;
  PictureSize size;      // of the picture that was asked
  PictureSize measured;  // of those that were rendered
  int rounds = 0;        // of each point that no other beat before
  int threads = 1;       // that full_seconds() is predicted for
  Configuration reference;
  std::string reference_plan, reference_picture_plan;  // of the first of its two pictures; as of Point
  double reference_cpu_ms = 0;                         // of one of the two
  // What the reference itself may be off, as an RMSE: half of that between two pictures with different seeds,
  // of which it is the mean. Smaller errors mean nothing.
  double reference_rmse = 0;
  std::vector<Point> points;  // by technique, depth, precision, samples

  double cheapest_ms() const;              // of the points
  std::vector<std::size_t> front() const;  // indices of the points on it, by cost

  // What so much CPU time of a measured picture is at the size asked, in seconds by the clock, if the threads
  // share the work alike and have nothing else to do.
  double full_seconds(double cpu_ms) const;
};

// Sets where each point stands, after the means and what the rounds that two points share tell of the
// differences, as paired t-intervals of 95 %. Errors below `floor` count as `floor`, and one that is smaller
// by less than 1 % as no smaller.
void mark_front(std::vector<Point>& points, double floor);

// The cheapest way to stay below an error.
struct Recommendation {
  double error;       // RMSE, linear colour
  std::size_t point;  // whose most_rmse() is below it
};
// For round errors from 0.1 down, as far as some point on the front reaches; of errors with the same answer
// the smallest alone.
std::vector<Recommendation> recommendations(const Chart& chart);

// "whitted 5, double": what a line of the chart joins.
std::string line_name(const Configuration& configuration);

// A drawing of 860 x 520: RMSE over CPU time as a multiple of the cheapest point's, both logarithmic. The
// mark of points[i] is the element with the id "point-i".
std::string svg_of(const Chart& chart);

}  // namespace orrery
