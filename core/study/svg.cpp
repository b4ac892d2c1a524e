#include "core/study/svg.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace orrery {
namespace {

std::vector<double> round_numbers(double low, double high) {
  const double power = std::pow(10, std::floor(std::log10((high - low) / 4)));
  double step = power;
  for (const double digit : {1.0, 2.0, 5.0})
    if ((high - low) / (digit * power) >= 4) step = digit * power;
  std::vector<double> ticks;
  for (double i = std::ceil(low / step); i * step <= high + step * 1e-3; ++i) ticks.push_back(i * step);
  return ticks;
}

}  // namespace

const char* line_color(std::size_t number) {
  constexpr std::array kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00",
                               "#000000", "#00466e", "#7d3700", "#00543d", "#84446a", "#7a5400"};
  return kColors[number % kColors.size()];
}

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
  for (const char* never : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})  // U+FFFE, U+FFFF are invalid in XML
    for (std::size_t at; (at = out.find(never)) != std::string::npos;) out.replace(at, 3, "?");
  return out;
}

std::string svg_text(double x, double y, const std::string& text, const char* more) {
  return printed("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, more) + escaped(text) + "</text>\n";
}

std::string svg_line(double x0, double y0, double x1, double y1, const char* more) {
  return printed("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x0, y0, x1, y1, more);
}

std::string svg_begin(double width, double height, const std::string& title) {
  return printed(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
             "font-family=\"sans-serif\" font-size=\"13\" fill=\"%s\" role=\"img\">\n",
             width, height, width, height, kInk) +
         "<title>" + escaped(title) + "</title>\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
}

double Axis::place(double value) const {
  const double within = std::clamp(value, low, high);
  const double share =
      logarithmic ? std::log(within / low) / std::log(high / low) : (within - low) / (high - low);
  return from + share * (to - from);
}

std::vector<double> Axis::ticks() const {
  if (!logarithmic) return round_numbers(low, high);
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

}  // namespace orrery
