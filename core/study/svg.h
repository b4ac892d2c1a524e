#pragma once

#include <cstdio>
#include <string>
#include <vector>

// SVG elements for charts.
namespace orrery {

inline constexpr const char* kInk = "#222222";
inline constexpr const char* kFaint = "#dddddd";
// Returns the colour of line `number`. Colour-blind readers can distinguish the first 7 colours (Okabe and
// Ito, 2008). The other 5 are darker shades of some of these. The sequence repeats after 12 lines.
const char* line_color(std::size_t number);

// Formats with std::snprintf(). Truncates the result to 511 bytes.
template <class... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Escapes UTF-8 text for XML 1.0: escapes markup, and replaces characters that XML does not allow.
std::string escaped(const std::string& text);

// Return an SVG element. `more` contains additional attributes.
std::string svg_text(double x, double y, const std::string& text, const char* more = "");
std::string svg_line(double x0, double y0, double x1, double y1, const char* more);
// Returns the beginning of an SVG document: the root, a title for screen readers, and a white background.
std::string svg_begin(double width, double height, const std::string& title);

// Axis with values from `low` to `high`, drawn at coordinates from `from` to `to`.
struct Axis {
  double low, high, from, to;
  bool logarithmic = true;

  // Returns the coordinate of `value`, clamped to the axis. REQUIRES: low < high, and 0 < low if logarithmic.
  double place(double value) const;
  // Returns the values of the tick marks. A logarithmic axis has 1, 2 and 5 times the powers of ten, only the
  // powers of ten if high / low exceeds 1000, or no ticks if `low` is not positive. A linear axis has 4 to 11
  // round numbers.
  std::vector<double> ticks() const;
};

}  // namespace orrery
