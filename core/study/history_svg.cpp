#include <algorithm>

#include "core/base/base64.h"
#include "core/model/technique.h"
#include "core/study/history.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

constexpr int kColumns = 4;
constexpr double kCell = 300, kMargin = 12, kTitle = 40, kLine = 17, kLines = 5;  // pixels of the drawing
constexpr std::size_t kFits = 46;  // characters of a line of text

// Divides a text into lines of at most kFits characters, at spaces.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines{""};
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > kFits) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    from = to + 1;
  }
  return lines;
}

std::string draw_step(const History& history, int number, double x, double y, double height) {
  const HistoryStep& step = history.steps()[static_cast<std::size_t>(number)];
  std::string text =
      printed("<image x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" href=\"", x, y, kCell, height);
  text += "data:image/png;base64," + encode_base64(history.png(number)) + "\"/>\n";
  double line = y + height + kLine;
  text += svg_text(x, line, std::string(step.technique->name) + ", " + step.technique->origin,
                   "font-weight=\"bold\"");
  const bool last = number + 1 == history.pictures();
  const std::string rays = step.rays > 0 ? printed("%.3g M rays, ", double(step.rays) / 1e6) : "";
  text += svg_text(x, line += kLine,
                   printed(step.cpu_ms < 100 ? "%.3g ms CPU, " : "%.0f ms CPU, ", step.cpu_ms) + rays +
                       (last ? std::string("reference") : printed("RMS %.2g", step.rms)));
  for (const std::string& words : lines_of(missing_sentence(step))) text += svg_text(x, line += kLine, words);
  return text;
}

}  // namespace

std::string history_svg(const History& history) {
  const int columns = std::min(kColumns, history.pictures()),
            rows = (history.pictures() + columns - 1) / columns;
  const double height = kCell * history.height() / history.width();
  const double row = height + kLine * kLines + 2 * kMargin;
  const std::string name = history.scene().title.empty() ? "Scene" : history.scene().title;
  std::string text =
      svg_begin(columns * (kCell + kMargin) + kMargin, kTitle + rows * row, "History of " + name);
  text += svg_text(kMargin, 26, name, "font-size=\"18\" font-weight=\"bold\"");
  for (int i = 0; i < history.pictures(); ++i)
    text +=
        draw_step(history, i, kMargin + i % columns * (kCell + kMargin), kTitle + i / columns * row, height);
  return text + "</svg>\n";
}

}  // namespace orrery
