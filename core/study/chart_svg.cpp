#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/study/chart.h"

namespace orrery {
namespace {

constexpr double kChartWidth = 860, kChartHeight = 520, kLeft = 84, kRight = 620, kTop = 76, kBottom = 452,
                 kZeroLane = 30;
constexpr const char* kInk = "#222222";
constexpr const char* kFaint = "#dddddd";
constexpr const char* kBelowFloor = "#999999";
// Colours that the colour-blind tell apart (Okabe and Ito, 2008).
// The last ones repeat their hues darker, for ladders of many depths.
constexpr std::array kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00",
                             "#000000", "#00466e", "#7d3700", "#00543d", "#84446a", "#7a5400"};

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Text of any UTF-8 as XML 1.0 takes it: without markup and control characters.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  for (const char* never : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})  // U+FFFE, U+FFFF
    for (std::size_t at; (at = out.find(never)) != std::string::npos;) out.replace(at, 3, "?");
  return out;
}

// The beginning, if the whole does not fit into a line.
std::string shortened(const std::string& text) {
  constexpr std::size_t kFits = 70;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80;  // UTF-8
    if (begins && ++characters > kFits) return text.substr(0, i) + "...";
  }
  return text;
}

std::string words(double x, double y, const std::string& text, const char* more = "") {
  return print("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, more) + escaped(text) + "</text>\n";
}

// A logarithmic axis from `low` to `high`, drawn from `from` to `to`.
struct Axis {
  double low, high, from, to;

  double place(double value) const {
    const double share = std::log(std::clamp(value, low, high) / low) / std::log(high / low);
    return from + share * (to - from);
  }
  // 1, 2 and 5 times the powers of ten; over many of these, the powers alone.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (!(low > 0)) return ticks;
    const bool many = high / low > 1e3;
    for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10, power) <= high * 1.001;
         ++power)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double tick = digit * std::pow(10, power);
        if (tick >= low * 0.999 && tick <= high * 1.001 && (digit == 1 || !many)) ticks.push_back(tick);
      }
    return ticks;
  }
};

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
    text_ = print(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
        "font-family=\"sans-serif\" font-size=\"13\" fill=\"%s\" role=\"img\">\n",
        kChartWidth, kChartHeight, kChartWidth, kChartHeight, kInk);
    text_ += "<title>" + escaped("Speed against accuracy of " + name()) + "</title>\n";
    text_ += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    text_ += words(kLeft, 30, shortened(name()), "font-size=\"18\" font-weight=\"bold\"");
    text_ += words(kLeft, 52,
                   print("%d x %d pixels; error against %s depth %d in double precision, %d samples",
                         chart_.measured.width, chart_.measured.height, chart_.reference.technique.c_str(),
                         chart_.reference.max_depth, chart_.reference.samples));
    draw_axes();
    draw_floor();
    draw_lines();
    draw_legend();
    return text_ + "</svg>\n";
  }

 private:
  std::string name() const { return chart_.title.empty() ? "a scene without title" : chart_.title; }
  double x_of(const Point& p) const { return x_.place(p.cpu_ms() / cheapest_ms_); }
  double y_of(const Point& p) const { return p.rmse() > 0 ? y_.place(p.rmse()) : kBottom - kZeroLane / 3; }

  void line(double x0, double y0, double x1, double y1, const char* more) {
    text_ += print("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x0, y0, x1, y1, more);
  }

  void draw_axes() {
    const std::string grid = print("stroke=\"%s\"", kFaint);
    for (const double tick : x_.ticks()) {
      line(x_.place(tick), kTop, x_.place(tick), kBottom, grid.c_str());
      text_ += words(x_.place(tick), kBottom + 20, print("%g", tick), "text-anchor=\"middle\"");
    }
    if (has_zero_) text_ += words(kLeft - 8, kBottom - kZeroLane / 3 + 4, "0", "text-anchor=\"end\"");
    for (const double tick : y_.ticks()) {
      line(kLeft, y_.place(tick), kRight, y_.place(tick), grid.c_str());
      text_ += words(kLeft - 8, y_.place(tick) + 4, print("%g", tick), "text-anchor=\"end\"");
    }
    text_ += words((kLeft + kRight) / 2, kBottom + 46,
                   print("CPU time of a picture, times the cheapest (%.3g ms)", cheapest_ms_),
                   "text-anchor=\"middle\"");
    const double middle = (kTop + kBottom) / 2;
    text_ += words(22, middle, "RMS error, linear colour",
                   print("text-anchor=\"middle\" transform=\"rotate(-90 22 %.1f)\"", middle).c_str());
  }

  // Below this, an error is the reference's own.
  void draw_floor() {
    if (!(chart_.reference_rmse > 0)) return;
    const double y = y_.place(chart_.reference_rmse);
    line(kLeft, y, kRight, y, "stroke=\"#888888\" stroke-dasharray=\"2 4\"");
    text_ += words(kLeft + 6, y - 5, print("the reference is off by about %.2g", chart_.reference_rmse),
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
        path += print("%.1f,%.1f ", x_of(chart_.points[i]), y_of(chart_.points[i]));
      text_ += "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + color + "\"" +
               (configuration.double_precision ? " stroke-dasharray=\"6 4\"" : "") + "/>\n";
      for (std::size_t i = from; i < to; ++i) draw_mark(i, color);
    }
  }

  void draw_mark(std::size_t index, const char* color) {
    const Point& p = chart_.points[index];
    const double x = x_of(p), y = y_of(p);
    const bool below = p.rmse() < chart_.reference_rmse;
    std::string told = print("%s, %d samples: %.3g ms, RMSE %.3g", line_name(p.configuration).c_str(),
                             p.configuration.samples, p.cpu_ms(), p.rmse());
    if (const auto error = p.rmse_interval())
      told += print(" (95 %%: %.3g to %.3g)", error->low, error->high);
    if (p.standing == Standing::undecided) told += ", perhaps on the front";
    if (below) told += ", less than the reference is off";
    text_ += print("<g id=\"point-%zu\">", index) +
             mark(x, y, p.configuration.double_precision, p.standing, below ? kBelowFloor : color, told) +
             "</g>\n";
    if (p.on_front())
      text_ += words(x + 8, y - 7, std::to_string(p.configuration.samples), "font-size=\"11\"");
  }

  // Filled on the front, half filled where that is undecided.
  static std::string mark(double x, double y, bool square, Standing standing, const char* color,
                          const std::string& told) {
    const std::string style = print("fill=\"%s\" stroke=\"%s\" stroke-width=\"2\"",
                                    standing == Standing::front ? color : "#ffffff", color);
    const std::string whole = square
                                  ? print("<rect x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"9\" %s>", x - 4.5,
                                          y - 4.5, style.c_str())
                                  : print("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" %s>", x, y, style.c_str());
    std::string half;
    if (standing == Standing::undecided)
      half = square ? print("<path d=\"M%.1f %.1fh-4.5v9h4.5z\" fill=\"%s\"/>", x, y - 4.5, color)
                    : print("<path d=\"M%.1f %.1fa5 5 0 0 0 0 10z\" fill=\"%s\"/>", x, y - 5, color);
    return whole + "<title>" + escaped(told) + "</title>" + (square ? "</rect>" : "</circle>") + half;
  }

  // One for each technique and depth.
  const char* color_of(const Configuration& configuration) const {
    std::size_t models = 0;
    for (std::size_t i = 0; i < chart_.points.size(); ++i) {
      const Configuration& at = chart_.points[i].configuration;
      if (at.technique == configuration.technique && at.max_depth == configuration.max_depth) break;
      const bool last_of_model = chart_.points[i + 1].configuration.technique != at.technique ||
                                 chart_.points[i + 1].configuration.max_depth != at.max_depth;
      models += last_of_model;
    }
    return kColors[models % kColors.size()];
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
      text_ += mark(x, y - 4, false, Standing::front, color_of(c), "");
      text_ += words(x + 16, y, c.technique + " " + std::to_string(c.max_depth));
      y += 22;
    }
    for (const char* note :
         {"technique and ray depth", "square, dashed: double", "", "filled: no other is faster and",
          "nearer; half filled: the rounds", "differ too much to tell; beside", "it, the samples a pixel", "",
          "grey: nearer than the", "reference can tell"}) {
      text_ += words(x - 6, y + 4, note, "fill=\"#666666\" font-size=\"11\"");
      y += *note ? 15 : 7;
    }
  }

  const Chart& chart_;
  const double cheapest_ms_;
  Axis x_{}, y_{};         // y_ has no ticks if all errors are 0
  bool has_zero_ = false;  // and a lane for them below the axis
  std::string text_;
};

}  // namespace

std::string svg_of(const Chart& chart) { return Drawing(chart).draw(); }

}  // namespace orrery
