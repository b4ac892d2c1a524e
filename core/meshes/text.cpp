#include "core/meshes/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"

namespace orrery {
namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' ' && !is_line_end(c); }

// Removes a leading "+", which from_chars does not accept.
std::string_view unsigned_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

void TextReader::pass_line_end() {
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
  ++line_;
}

bool TextReader::joins_at(std::size_t i) const {
  return joining_ && rest_[i] == '\\' && i + 1 < rest_.size() && is_line_end(rest_[i + 1]);
}

std::string_view TextReader::word_of_line() {
  checkpoint();
  std::size_t from = 0;
  while (from < rest_.size()) {
    if (is_blank(rest_[from])) {
      ++from;
    } else if (joins_at(from)) {
      rest_.remove_prefix(from + 1);
      pass_line_end();
      from = 0;
    } else {
      break;
    }
  }
  std::size_t to = from;
  while (to < rest_.size() && !is_blank(rest_[to]) && !is_line_end(rest_[to]) && !joins_at(to)) ++to;
  const std::string_view word = rest_.substr(from, to - from);
  rest_.remove_prefix(to);
  return word;
}

std::string_view TextReader::word() {
  checkpoint();
  std::size_t from = 0;
  while (from < rest_.size() && static_cast<unsigned char>(rest_[from]) <= ' ') {
    if (is_line_end(rest_[from])) {
      rest_.remove_prefix(from);
      pass_line_end();
      from = 0;
    } else {
      ++from;
    }
  }
  std::size_t to = from;
  while (to < rest_.size() && static_cast<unsigned char>(rest_[to]) > ' ') ++to;
  const std::string_view word = rest_.substr(from, to - from);
  rest_.remove_prefix(to);
  return word;
}

bool TextReader::next_line(bool may_join) {
  checkpoint();
  while (!rest_.empty()) {
    const std::size_t end = rest_.find_first_of("\r\n");
    if (end == std::string_view::npos) {
      rest_ = {};
      break;
    }
    const bool joined = may_join && end > 0 && joins_at(end - 1);
    rest_.remove_prefix(end);
    pass_line_end();
    if (!joined) break;
  }
  return !rest_.empty();
}

bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

void TextReader::end_text(bool lone_returns) {
  rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
  if (lone_returns && rest_.starts_with('\r'))
    rest_.remove_prefix(1);
  else if (!rest_.empty())
    pass_line_end();
}

double TextReader::parse_number(std::string_view word, std::string_view name) const {
  const std::string_view digits = unsigned_plus(word);
  const char* end = digits.data() + digits.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  // from_chars() reports overflow and underflow by the same error. Numbers that underflow are rounded to 0.
  const bool vanishes = error == std::errc::result_out_of_range && stop == end &&
                        std::fabs(std::strtod(std::string(digits).c_str(), nullptr)) < 1;
  if (vanishes) return 0;
  if (error != std::errc() || stop != end || !std::isfinite(value))
    fail(std::string(name) + " must be a finite number (got " + (word.empty() ? "nothing" : excerpt(word)) +
         ")");
  return value;
}

std::int64_t TextReader::integer_in(std::string_view word, std::string_view name) const {
  const std::string_view digits = unsigned_plus(word);
  const char* end = digits.data() + digits.size();
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc() || stop != end)
    fail(std::string(name) + " must be an integer (got " + (word.empty() ? "nothing" : excerpt(word)) + ")");
  return value;
}

void TextReader::fail(const std::string& detail) const { fail_at("line " + std::to_string(line_), detail); }

std::string excerpt(std::string_view text, std::size_t longest) {
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return '"' + shown + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace orrery
