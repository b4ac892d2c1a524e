#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace orrery {

// Reads text word by word, without copying it. Words are separated by blanks and control characters. Lines
// end with \n, \r or \r\n, are numbered from 1 and may have any length. Functions that read or skip words
// throw Cancelled. Not thread-safe.
class TextReader {
 public:
  // With `joining`, a backslash at the end of a line joins it with the next line.
  explicit TextReader(std::string_view text, bool joining = false) : rest_(text), joining_(joining) {}

  // Returns the next word of this line, or an empty string at the end of the line.
  std::string_view word_of_line();
  // Returns the rest of this line without blanks around it. A backslash at its end does not join lines.
  std::string_view rest_of_line();
  // Returns the next word on this line or a later one, or an empty string at the end of the text.
  std::string_view word();
  // Moves to the start of the next line. With `may_join`, also skips the lines that are joined to this one.
  // Returns false at the end of the text.
  bool next_line(bool may_join = true);
  // Moves past the end of this line, to binary data. With `lone_returns`, a line ends with \r alone, and a \n
  // after it belongs to the data.
  void end_text(bool lone_returns);

  // Returns the next word on this line or a later one as a number: see parse_number().
  double number(std::string_view name) { return parse_number(word(), name); }

  // Converts `word` to the nearest double, or to an integer. Throws InputError with the line number, `name`
  // and the word if the word is not a number or is out of range.
  double parse_number(std::string_view word, std::string_view name) const;
  std::int64_t integer_in(std::string_view word, std::string_view name) const;

  [[noreturn]] void fail(const std::string& detail) const;  // throws InputError with the line number
  std::string_view rest() const { return rest_; }

 private:
  void pass_line_end();                // REQUIRES: rest_ begins with a line end
  bool joins_at(std::size_t i) const;  // true if a backslash at i joins the next line

  std::string_view rest_;
  bool joining_;
  std::size_t line_ = 1;
};

// Returns the text with the letters A to Z in lower case.
std::string lower_case(std::string_view text);

// Returns `text` for a message: quoted, truncated to `longest` bytes, and with "?" for each byte that is not
// printable ASCII.
std::string excerpt(std::string_view text, std::size_t longest = 40);

// Returns the text if it is valid UTF-8 (RFC 3629), and else with "?" for each byte that is not ASCII. Names
// of materials can have any encoding.
std::string as_utf8(std::string_view text);

}  // namespace orrery
