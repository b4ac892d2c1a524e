#include "server/import/pbrt_lexer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/base/number.h"
#include "core/base/task_scope.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::string_view kPbrtBlanks = " \t\r\n\f\v";
constexpr std::string_view kWordEnds = " \t\r\n\f\v\"[]#";

}  // namespace

void PbrtLexer::skip_blanks() {
  while (!rest_.empty()) {
    const std::size_t blanks = std::min(rest_.find_first_not_of(kPbrtBlanks), rest_.size());
    line_ += static_cast<std::size_t>(
        std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(blanks), '\n'));
    rest_.remove_prefix(blanks);
    if (!rest_.starts_with('#')) return;
    rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
  }
}

PbrtToken PbrtLexer::take(PbrtToken::Kind kind, std::size_t size) {
  const PbrtToken token{kind, rest_.substr(0, size), line_};
  rest_.remove_prefix(size);
  return token;
}

PbrtToken PbrtLexer::quoted() {
  std::size_t end = 1;
  while (end < rest_.size() && rest_[end] != '"' && rest_[end] != '\n')
    end += rest_[end] == '\\' && end + 1 < rest_.size() && rest_[end + 1] != '\n' ? 2 : 1;
  if (end >= rest_.size() || rest_[end] != '"')
    refuse_at(place(), "text must end with \" on its line (got " + excerpt(rest_.substr(1, end - 1)) + ")");
  PbrtToken token = take(PbrtToken::Kind::text, end + 1);
  token.text = token.text.substr(1, end - 1);
  return token;
}

PbrtToken PbrtLexer::next() {
  checkpoint();
  skip_blanks();
  if (rest_.empty()) return {PbrtToken::Kind::end, {}, line_};
  switch (rest_.front()) {
    case '"': return quoted();
    case '[': return take(PbrtToken::Kind::open, 1);
    case ']': return take(PbrtToken::Kind::close, 1);
    default: return take(PbrtToken::Kind::word, std::min(rest_.find_first_of(kWordEnds), rest_.size()));
  }
}

PbrtToken PbrtLexer::peek() {
  const std::string_view rest = rest_;
  const std::size_t line = line_;
  const PbrtToken token = next();
  rest_ = rest;
  line_ = line;
  return token;
}

double PbrtLexer::number(const PbrtToken& word, std::string_view name) const {
  std::string_view digits = word.text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const std::optional<double> value = parse_number<double>(digits);
  if (word.is(PbrtToken::Kind::word) && value && std::isfinite(*value)) return *value;
  // from_chars() reports numbers that are too small for a double like those that are too large.
  if (word.is(PbrtToken::Kind::word) && digits.find_first_not_of("0123456789+-.eE") == digits.npos) {
    char* end = nullptr;
    const std::string text(digits);
    const double rounded = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && std::abs(rounded) < 1) return 0;
  }
  refuse_at(place_of(word), std::string(name) + " must be a finite number (got " +
                                (word.text.empty() ? "nothing" : excerpt(word.text)) + ")");
}

std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      plain += text[i];
      continue;
    }
    const char escaped = text[++i];
    plain += escaped == 'n' ? '\n' : escaped == 't' ? '\t' : escaped;
  }
  return plain;
}

}  // namespace orrery
