#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/certificate.h"
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

// Cost and error of one image.
struct Measurement {
  Difference difference;  // from the reference
  double ssim = 1;        // structural similarity to the reference; see ssim()
  double cpu_ms = 0;      // time to trace, summed over all threads
  double rays = 0;        // number of rays traced
};

// Pareto status of a point. front: more accurate or faster than every other point. undecided: the rounds
// differ too much to decide. dominated: another point is faster and at least as accurate.
enum class ParetoStatus { front, undecided, dominated };

// Images of one configuration with different seeds, one per round. All points use the same seed in a round.
struct Point {
  Configuration configuration;
  std::vector<Measurement> rounds;
  std::string accelerator;  // chosen by the plan, or requested
  // Query strings of frame.png for the image of the first round: at the requested size, and at most
  // kPictureWidth pixels wide.
  std::string plan, picture_plan;
  std::optional<Certificate> certificate = {};  // first round
  ParetoStatus pareto_status = ParetoStatus::dominated;

  double rmse() const;     // square root of the mean square error of all rounds
  double rmse_sd() const;  // standard deviation of the RMSE of a round; 0 for one round
  double psnr_db() const;  // 10 log10(1 / MSE of all rounds), values clamped to [0, 1]; may be infinite
  double cpu_ms() const;   // mean over rounds
  double rays() const;     // mean over rounds
  // Return the 95 % confidence interval of the mean over the rounds, clipped at 0, or nullopt for fewer than
  // two rounds.
  std::optional<Interval> rmse_interval() const;
  std::optional<Interval> cpu_ms_interval() const;
  // Returns an upper bound of the error: the upper end of rmse_interval(), or the RMSE of a single round.
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

inline constexpr int kPictureWidth = 320;  // pixels; maximum width of the images that a chart links to

struct PictureSize {
  int width = 0, height = 0;
};
// Returns a size with the same aspect ratio that is `width` wide. REQUIRES: 1 <= width <= size.width.
PictureSize narrowed(const PictureSize& size, int width);

// Speed against accuracy for one view of a scene.
struct Chart {
  std::string scene_id, title;
  PictureSize size;      // requested image
  PictureSize measured;  // rendered images
  int rounds = 0;        // maximum number of rounds of a point; dominated points have fewer
  int threads = 1;       // assumed by full_seconds()
  Configuration reference;
  std::string reference_plan, reference_picture_plan;  // first image of the reference; see Point
  double reference_cpu_ms = 0;                         // CPU time to trace the second image of the reference
  // Estimated RMSE of the reference, which is the mean of two images with different seeds: half of the RMSE
  // between the two. Errors below it are meaningless.
  double reference_rmse = 0;
  std::vector<Point> points;  // by technique, depth, precision, samples

  double cheapest_ms() const;              // minimum over the points
  std::vector<std::size_t> front() const;  // indices of points on the front, by cost

  // Converts the CPU time of a rendered image to wall-clock seconds at the requested size. Assumes that the
  // threads share the work evenly and do nothing else.
  double full_seconds(double cpu_ms) const;
};

// Sets the Pareto status of each point. Compares two points by paired 95 % t-intervals over their common
// rounds, and by the intervals of their means. Errors below `floor` count as `floor`. Errors that differ by
// less than 1 % count as equal.
void mark_pareto_front(std::vector<Point>& points, double floor);

// Cheapest point with an error below a limit.
struct Recommendation {
  double error;       // limit of the RMSE, in linear colour
  std::size_t point;  // index; its max_rmse() is below `error`
};
// Returns recommendations for the limits 0.1, 0.05, 0.02, 0.01, ..., 0.0001, down to the smallest limit that
// the front reaches. Among limits with the same point, only the smallest is listed.
std::vector<Recommendation> recommendations(const Chart& chart);

// Returns the name of the chart line that a configuration belongs to: "whitted 5, double".
std::string line_name(const Configuration& configuration);

// Draws the chart in 860 x 520 SVG units: RMSE against CPU time relative to the cheapest point, on
// logarithmic axes. The mark of points[i] is the element with the id "point-i".
std::string svg_of(const Chart& chart);

}  // namespace orrery
