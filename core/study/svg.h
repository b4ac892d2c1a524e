#pragma once

#include <cstdio>
#include <string>
#include <vector>

// SVG elements for charts.
namespace orrery {

inline constexpr const char* kInk = "#222222";
inline constexpr const char* kFaint = "#dddddd";
// Returns colours that colour-blind readers can distinguish (Okabe and Ito, 2008), in turn. The last ones
// repeat the hues in darker shades, for many lines.
const char* line_color(std::size_t number);

// Formats with std::snprintf(). Cuts the result to 511 bytes.
template <class... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Escapes UTF-8 text for XML 1.0: markup is escaped, control characters are replaced.
std::string escaped(const std::string& text);

// Return an element; `more` are attributes.
std::string svg_text(double x, double y, const std::string& text, const char* more = "");
std::string svg_line(double x0, double y0, double x1, double y1, const char* more);
// Returns the beginning of an SVG document: the root, a title for screen readers, and a white background.
std::string svg_begin(double width, double height, const std::string& title);

// Axis from `low` to `high`, drawn from `from` to `to`. REQUIRES: 0 < low < high if logarithmic.
struct Axis {
  double low, high, from, to;
  bool logarithmic = true;

  double place(double value) const;
  // Returns 1, 2 and 5 times the powers of ten, or only the powers if there are many. A linear axis has 4 to
  // 11 round numbers. A logarithmic axis that begins at 0 has none.
  std::vector<double> ticks() const;
};

}  // namespace orrery
