#include "core/stability/line_chart.h"

#include <algorithm>
#include <cmath>

#include "core/study/svg.h"

namespace orrery {
namespace {

constexpr double kWidth = 660, kHeight = 360, kLeft = 84, kRight = 440, kTop = 48, kBottom = 292,
                 kZeroLane = 26;

// Returns an axis whose range contains the values. The range of a linear axis also contains 0. A logarithmic
// axis ignores values of at most 0.
Axis axis_of(std::vector<double> values, bool logarithmic, double from, double to) {
  if (logarithmic) std::erase_if(values, [](double value) { return value <= 0; });
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {logarithmic ? *least : std::min(0.0, *least), *most, from, to, logarithmic};
}

// Extends a logarithmic axis to powers of ten; returns other axes unchanged.
Axis to_powers_of_ten(Axis axis) {
  if (!axis.logarithmic) return axis;
  axis.low = std::pow(10, std::floor(std::log10(axis.low)));
  axis.high = std::max(10 * axis.low, std::pow(10, std::ceil(std::log10(axis.high))));
  return axis;
}

class LineDrawing {
 public:
  explicit LineDrawing(const LineChart& chart) : chart_(chart) {
    std::vector<double> xs, ys;
    for (const auto& series : chart.series)
      for (const auto& [x, y] : series.points) {
        xs.push_back(x);
        ys.push_back(y);
        has_zero_ = has_zero_ || (chart.log_y && y == 0);
      }
    x_ = axis_of(xs, chart.log_x, kLeft, kRight);
    y_ = to_powers_of_ten(axis_of(ys, chart.log_y, has_zero_ ? kBottom - kZeroLane : kBottom, kTop));
  }

  std::string draw() {
    text_ = svg_begin(kWidth, kHeight, chart_.title) +
            svg_text(kLeft, 26, chart_.title, "font-size=\"15\" font-weight=\"bold\"");
    draw_axes();
    for (std::size_t i = 0; i < chart_.series.size(); ++i) draw_series(i);
    return text_ + "</svg>\n";
  }

 private:
  double y_of(double value) const {
    return chart_.log_y && value == 0 ? kBottom - kZeroLane / 3 : y_.place(value);
  }

  void draw_axes() {
    const std::string grid = printed("stroke=\"%s\"", kFaint);
    for (const double tick : x_.ticks()) {
      text_ += svg_line(x_.place(tick), kTop, x_.place(tick), kBottom, grid.c_str()) +
               svg_text(x_.place(tick), kBottom + 18, printed("%g", tick), "text-anchor=\"middle\"");
    }
    if (has_zero_) text_ += svg_text(kLeft - 8, y_of(0) + 4, "0", "text-anchor=\"end\"");
    for (const double tick : y_.ticks()) {
      text_ += svg_line(kLeft, y_.place(tick), kRight, y_.place(tick), grid.c_str()) +
               svg_text(kLeft - 8, y_.place(tick) + 4, printed("%.4g", tick), "text-anchor=\"end\"");
    }
    const double middle = (kTop + kBottom) / 2;
    text_ += svg_text((kLeft + kRight) / 2, kBottom + 44, chart_.x, "text-anchor=\"middle\"") +
             svg_text(18, middle, chart_.y,
                      printed("text-anchor=\"middle\" transform=\"rotate(-90 18 %.1f)\"", middle).c_str());
  }

  void draw_series(std::size_t number) {
    const LineChart::Series& series = chart_.series[number];
    const char* color = line_color(number);
    std::string path, marks;
    for (const auto& [x, y] : series.points) {
      path += printed("%.1f,%.1f ", x_.place(x), y_of(y));
      marks +=
          printed("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x_.place(x), y_of(y), color);
    }
    text_ += std::string("<polyline points=\"") + path +
             printed("\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n", color);
    if (series.points.size() <= 20) text_ += marks;
    const double y = kTop + 14 + 22 * static_cast<double>(number), x = kRight + 20;
    text_ += svg_line(x, y - 4, x + 18, y - 4, printed("stroke=\"%s\" stroke-width=\"2\"", color).c_str()) +
             svg_text(x + 24, y, series.name, "font-size=\"12\"");
  }

  const LineChart& chart_;
  Axis x_{}, y_{};
  bool has_zero_ = false;  // values of 0 are drawn in a lane below a logarithmic y axis
  std::string text_;
};

}  // namespace

std::string svg_of(const LineChart& chart) { return LineDrawing(chart).draw(); }

}  // namespace orrery
