#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace orrery {

// Reads a text word by word. Blanks and control characters part words; lines end with \n, \r or \r\n and
// count from 1. No copy of the text is made, so that no line is too long.
class TextReader {
 public:
  // If `joining`, a backslash at the end of a line joins the next one to it.
  explicit TextReader(std::string_view text, bool joining = false) : rest_(text), joining_(joining) {}

  // The next word of this line; empty at its end.
  std::string_view word_of_line();
  // The next word on this line or a later one; empty at the end of the text.
  std::string_view word();
  // Goes to the start of the next line, or of the one after those that a backslash joins to it. False at the
  // end of the text.
  bool next_line(bool may_join = true);
  // Goes to the start of the next line, which is not text: a \n after a \r belongs to it if `lone_returns`.
  void end_text(bool lone_returns);

  // The next word on this line or a later one as a number (see number_in).
  double number(std::string_view what) { return number_in(word(), what); }

  // The number that `word` spells, as the nearest double; integers, from `min` to `max`. Throws InputError
  // that names the line, `what` and the word if it is no such number or not finite.
  double number_in(std::string_view word, std::string_view what) const;
  std::int64_t integer_in(std::string_view word, std::string_view what) const;

  [[noreturn]] void fail(const std::string& detail) const;  // InputError with the line
  std::string_view rest() const { return rest_; }

 private:
  void pass_line_end();                // REQUIRES: rest_ begins with one
  bool joins_at(std::size_t i) const;  // whether a backslash there joins the next line

  std::string_view rest_;
  bool joining_;
  std::size_t line_ = 1;
};

// `text` for a message: in quotes, cut to `longest` bytes, with "?" for what cannot be shown.
std::string excerpt(std::string_view text, std::size_t longest = 40);

}  // namespace orrery
