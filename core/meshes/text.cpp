#include "core/meshes/text.h"

#include <algorithm>
#include <array>
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

// Returns the number of bytes of the first character, or 0 if it is not valid.
std::size_t character_size(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return 0;
  std::uint32_t code = lead & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte & 0x3f);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code < kSmallest[size] || code > 0x10ffff || is_surrogate ? 0 : size;
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

std::string_view TextReader::rest_of_line() {
  checkpoint();
  std::string_view line = rest_.substr(0, rest_.find_first_of("\r\n"));
  rest_.remove_prefix(line.size());
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line;
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

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string excerpt(std::string_view text, std::size_t longest) {
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return '"' + shown + (text.size() > longest ? "...\"" : "\"");
}

std::string as_utf8(std::string_view text) {
  std::string valid(text);
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_size(text.substr(i));
    if (size == 0) {
      for (char& c : valid)
        if (static_cast<unsigned char>(c) >= 0x80) c = '?';
      break;
    }
    i += size;
  }
  return valid;
}

}  // namespace orrery
