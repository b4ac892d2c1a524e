#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/render/certificate.h"
#include "core/study/difference.h"
#include "core/study/interval.h"

namespace orrery {

// Settings that a chart varies.
struct Configuration {
  std::string technique;
  int max_depth = 0;
  bool double_precision = false;
  int samples = 1;
};

// Cost and error of one picture.
struct Measurement {
  Difference difference;  // from the reference
  double ssim = 1;        // with the reference; see ssim()
  double cpu_ms = 0;      // all threads, without building
  double rays = 0;        // rays traced
};

// Position of a point in a chart. front: more accurate or faster than each other point. undecided: the rounds
// differ too much to decide. dominated: another point is faster and at least as accurate.
enum class ParetoStatus { front, undecided, dominated };

// Several pictures of one configuration with different seeds. The n-th rounds of all points share a seed.
struct Point {
  Configuration configuration;
  std::vector<Measurement> rounds;
  std::string accelerator;  // chosen by the plan or the view
  // Queries of frame.png for the first round's picture: at the requested size, and at most kPictureWidth
  // wide.
  std::string plan, picture_plan;
  std::optional<Certificate> certificate = {};  // first round
  ParetoStatus pareto_status = ParetoStatus::dominated;

  double rmse() const;     // sqrt of the mean square error of all rounds
  double rmse_sd() const;  // standard deviation of the rounds' errors; 0 for one round
  double psnr_db() const;  // 10 log10(1 / MSE of all rounds), values clamped to 0..1; may be infinite
  double cpu_ms() const;   // mean over rounds
  double rays() const;     // mean over rounds
  // Return the interval of the mean over the rounds, or nullopt for one round.
  std::optional<Interval> rmse_interval() const;
  std::optional<Interval> cpu_ms_interval() const;
  // Returns an upper bound of the error: the end of the interval, or the error of the only round.
  double max_rmse() const;
  bool on_front() const { return pareto_status != ParetoStatus::dominated; }
  // Returns the mean of value(round) over the rounds.
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0;
    for (const Measurement& s : rounds) sum += value(s);
    return sum / static_cast<double>(rounds.size());
  }
};

inline constexpr int kPictureWidth = 320;  // pixels; width of the pictures that a chart links to

struct PictureSize {
  int width = 0, height = 0;
};
// Returns a size with the same aspect ratio that is `width` wide. REQUIRES: 1 <= width <= size.width.
PictureSize narrowed(const PictureSize& size, int width);

// Speed against accuracy for one picture.
struct Chart {
  std::string scene_id, title;
  PictureSize size;      // requested picture
  PictureSize measured;  // rendered pictures
  int rounds = 0;        // per point that is not dominated earlier
  int threads = 1;       // assumed by full_seconds()
  Configuration reference;
  std::string reference_plan, reference_picture_plan;  // first of its two pictures; as in Point
  double reference_cpu_ms = 0;                         // one of the two pictures
  // Estimated RMSE of the reference: half of the RMSE between its two pictures, which have different seeds
  // and are averaged. Smaller errors are meaningless.
  double reference_rmse = 0;
  std::vector<Point> points;  // by technique, depth, precision, samples

  double cheapest_ms() const;              // minimum over the points
  std::vector<std::size_t> front() const;  // indices of points on the front, by cost

  // Converts the CPU time of a measured picture to wall-clock seconds at the requested size. Assumes that the
  // threads share the work evenly and do nothing else.
  double full_seconds(double cpu_ms) const;
};

// Sets the Pareto status of each point. Compares means, and paired t-intervals of 95 % over the rounds that
// two points share. Errors below `floor` count as `floor`, and a difference of less than 1 % as none.
void mark_pareto_front(std::vector<Point>& points, double floor);

// Cheapest way to stay below an error.
struct Recommendation {
  double error;       // RMSE, linear colour
  std::size_t point;  // its max_rmse() is below `error`
};
// Returns recommendations for round errors from 0.1 down to the smallest that the front reaches. Among errors
// with the same point, only the smallest is listed.
std::vector<Recommendation> recommendations(const Chart& chart);

// Returns the name of the chart line that a configuration belongs to: "whitted 5, double".
std::string line_name(const Configuration& configuration);

// Draws the chart with 860 x 520 units: RMSE over CPU time relative to the cheapest point, both logarithmic.
// The mark of points[i] is the element with the id "point-i".
std::string svg_of(const Chart& chart);

}  // namespace orrery
