#pragma once

#include <cstdio>
#include <string>
#include <vector>

// Parts of drawings in SVG.
namespace orrery {

inline constexpr const char* kInk = "#222222";
inline constexpr const char* kFaint = "#dddddd";
// Colours that the colour-blind tell apart (Okabe and Ito, 2008), in turn; the last ones repeat their hues
// darker, for many lines.
const char* line_color(std::size_t number);

// std::snprintf() as a string of at most 511 bytes.
template <class... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Text of any UTF-8 as XML 1.0 takes it: without markup and control characters.
std::string escaped(const std::string& text);

// Elements; `more` are attributes.
std::string svg_text(double x, double y, const std::string& text, const char* more = "");
std::string svg_line(double x0, double y0, double x1, double y1, const char* more);
// An SVG document up to its background, white, with a title for readers of screens.
std::string svg_begin(double width, double height, const std::string& title);

// An axis from `low` to `high`, drawn from `from` to `to`. REQUIRES: 0 < low < high if logarithmic.
struct Axis {
  double low, high, from, to;
  bool logarithmic = true;

  double place(double value) const;
  // 1, 2 and 5 times the powers of ten; over many of these, the powers alone. Of a linear axis 4 to 11 round
  // numbers. None if a logarithmic one begins at 0.
  std::vector<double> ticks() const;
};

}  // namespace orrery
