#include <algorithm>
#include <cmath>

#include "core/study/chart.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

constexpr double kChartWidth = 860, kChartHeight = 520, kLeft = 84, kRight = 620, kTop = 76, kBottom = 452,
                 kZeroLane = 30;
constexpr const char* kBelowFloor = "#999999";

// Truncates a text that does not fit on one line.
std::string shortened(const std::string& text) {
  constexpr std::size_t kFits = 70;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins =
        (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80;  // first byte of a UTF-8 character
    if (begins && ++characters > kFits) return text.substr(0, i) + "...";
  }
  return text;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart), cheapest_ms_(chart.cheapest_ms()) {
    double slowest = 2;
    std::vector<double> errors;
    for (const Point& p : chart.points) {
      slowest = std::max(slowest, p.cpu_ms() / cheapest_ms_);
      errors.push_back(p.rmse());
    }
    has_zero_ = std::erase(errors, 0.0) > 0;
    if (chart.reference_rmse > 0) errors.push_back(chart.reference_rmse);
    x_ = {1, slowest * 1.1, kLeft, kRight};
    if (errors.empty()) return;
    const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
    y_ = {std::pow(10, std::floor(std::log10(*least))), std::pow(10, std::ceil(std::log10(*most))),
          has_zero_ ? kBottom - kZeroLane : kBottom, kTop};
    if (!(y_.high > y_.low)) y_.high = y_.low * 10;
  }

  std::string draw() {
    text_ = svg_begin(kChartWidth, kChartHeight, "Speed against accuracy of " + name());
    text_ += svg_text(kLeft, 30, shortened(name()), "font-size=\"18\" font-weight=\"bold\"");
    text_ +=
        svg_text(kLeft, 52,
                 printed("%d x %d pixels; reference: %s, depth %d, double precision, %d samples",
                         chart_.measured.width, chart_.measured.height, chart_.reference.technique.c_str(),
                         chart_.reference.max_depth, chart_.reference.samples));
    draw_axes();
    draw_floor();
    draw_lines();
    draw_legend();
    return text_ + "</svg>\n";
  }

 private:
  std::string name() const { return chart_.title.empty() ? "untitled scene" : chart_.title; }
  double x_of(const Point& p) const { return x_.place(p.cpu_ms() / cheapest_ms_); }
  double y_of(const Point& p) const { return p.rmse() > 0 ? y_.place(p.rmse()) : kBottom - kZeroLane / 3; }

  void draw_axes() {
    const std::string grid = printed("stroke=\"%s\"", kFaint);
    for (const double tick : x_.ticks()) {
      text_ += svg_line(x_.place(tick), kTop, x_.place(tick), kBottom, grid.c_str());
      text_ += svg_text(x_.place(tick), kBottom + 20, printed("%g", tick), "text-anchor=\"middle\"");
    }
    if (has_zero_) text_ += svg_text(kLeft - 8, kBottom - kZeroLane / 3 + 4, "0", "text-anchor=\"end\"");
    for (const double tick : y_.ticks()) {
      text_ += svg_line(kLeft, y_.place(tick), kRight, y_.place(tick), grid.c_str());
      text_ += svg_text(kLeft - 8, y_.place(tick) + 4, printed("%g", tick), "text-anchor=\"end\"");
    }
    text_ += svg_text((kLeft + kRight) / 2, kBottom + 46,
                      printed("CPU time per image, relative to the cheapest (%.3g ms)", cheapest_ms_),
                      "text-anchor=\"middle\"");
    const double middle = (kTop + kBottom) / 2;
    text_ += svg_text(22, middle, "RMS error (linear)",
                      printed("text-anchor=\"middle\" transform=\"rotate(-90 22 %.1f)\"", middle).c_str());
  }

  // Draws the error of the reference. Smaller errors are meaningless.
  void draw_floor() {
    if (!(chart_.reference_rmse > 0)) return;
    const double y = y_.place(chart_.reference_rmse);
    text_ += svg_line(kLeft, y, kRight, y, "stroke=\"#888888\" stroke-dasharray=\"2 4\"");
    text_ += svg_text(kLeft + 6, y - 5, printed("error of the reference: about %.2g", chart_.reference_rmse),
                      "fill=\"#666666\" font-size=\"11\"");
  }

  void draw_lines() {
    for (std::size_t from = 0, to = 0; from < chart_.points.size(); from = to) {
      const Configuration& configuration = chart_.points[from].configuration;
      while (to < chart_.points.size() &&
             line_name(chart_.points[to].configuration) == line_name(configuration))
        ++to;
      const char* color = color_of(configuration);
      std::string path;
      for (std::size_t i = from; i < to; ++i)
        path += printed("%.1f,%.1f ", x_of(chart_.points[i]), y_of(chart_.points[i]));
      text_ += "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + color + "\"" +
               (configuration.double_precision ? " stroke-dasharray=\"6 4\"" : "") + "/>\n";
      for (std::size_t i = from; i < to; ++i) draw_mark(i, color);
    }
  }

  void draw_mark(std::size_t index, const char* color) {
    const Point& p = chart_.points[index];
    const double x = x_of(p), y = y_of(p);
    const bool below = p.rmse() < chart_.reference_rmse;
    std::string told = printed("%s, %d samples: %.3g ms, RMSE %.3g", line_name(p.configuration).c_str(),
                               p.configuration.samples, p.cpu_ms(), p.rmse());
    if (const auto error = p.rmse_interval())
      told += printed(" (95 %%: %.3g to %.3g)", error->low, error->high);
    if (p.pareto_status == ParetoStatus::undecided) told += ", possibly on the Pareto front";
    if (below) told += ", below the error of the reference";
    text_ +=
        printed("<g id=\"point-%zu\">", index) +
        mark(x, y, p.configuration.double_precision, p.pareto_status, below ? kBelowFloor : color, told) +
        "</g>\n";
    if (p.on_front())
      text_ += svg_text(x + 8, y - 7, std::to_string(p.configuration.samples), "font-size=\"11\"");
  }

  // Draws a mark: filled on the front, half filled if undecided, else empty.
  static std::string mark(double x, double y, bool square, ParetoStatus pareto_status, const char* color,
                          const std::string& told) {
    const std::string style = printed("fill=\"%s\" stroke=\"%s\" stroke-width=\"2\"",
                                      pareto_status == ParetoStatus::front ? color : "#ffffff", color);
    const std::string whole =
        square ? printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"9\" %s>", x - 4.5, y - 4.5,
                         style.c_str())
               : printed("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" %s>", x, y, style.c_str());
    std::string half;
    if (pareto_status == ParetoStatus::undecided)
      half = square ? printed("<path d=\"M%.1f %.1fh-4.5v9h4.5z\" fill=\"%s\"/>", x, y - 4.5, color)
                    : printed("<path d=\"M%.1f %.1fa5 5 0 0 0 0 10z\" fill=\"%s\"/>", x, y - 5, color);
    return whole + "<title>" + escaped(told) + "</title>" + (square ? "</rect>" : "</circle>") + half;
  }

  // Returns the colour of a technique and depth.
  const char* color_of(const Configuration& configuration) const {
    std::size_t models = 0;
    for (std::size_t i = 0; i < chart_.points.size(); ++i) {
      const Configuration& at = chart_.points[i].configuration;
      if (at.technique == configuration.technique && at.max_depth == configuration.max_depth) break;
      const bool last_of_model = chart_.points[i + 1].configuration.technique != at.technique ||
                                 chart_.points[i + 1].configuration.max_depth != at.max_depth;
      models += last_of_model;
    }
    return line_color(models);
  }

  void draw_legend() {
    double y = kTop + 12;
    const double x = kRight + 28;
    for (const Point& p : chart_.points) {
      const Configuration& c = p.configuration;
      const auto same_model = [&](const Point& q) {
        return q.configuration.technique == c.technique && q.configuration.max_depth == c.max_depth;
      };
      if (&*std::find_if(chart_.points.begin(), chart_.points.end(), same_model) != &p) continue;
      text_ += mark(x, y - 4, false, ParetoStatus::front, color_of(c), "");
      text_ += svg_text(x + 16, y, c.technique + " " + std::to_string(c.max_depth));
      y += 22;
    }
    for (const char* note :
         {"technique and ray depth", "square, dashed: double", "", "filled: on the Pareto front;",
          "half filled: possibly, the rounds", "differ too much to be certain;", "number: samples per pixel",
          "", "grey: below the error of", "the reference"}) {
      text_ += svg_text(x - 6, y + 4, note, "fill=\"#666666\" font-size=\"11\"");
      y += *note ? 15 : 7;
    }
  }

  const Chart& chart_;
  const double cheapest_ms_;
  Axis x_{}, y_{};         // y_ has no ticks if all errors are 0
  bool has_zero_ = false;  // errors of 0 are drawn in a lane below the axis
  std::string text_;
};

}  // namespace

std::string svg_of(const Chart& chart) { return Drawing(chart).draw(); }

}  // namespace orrery
