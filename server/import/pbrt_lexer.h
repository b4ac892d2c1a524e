#pragma once

#include <string>
#include <string_view>

#include "server/import/place.h"

namespace orrery {

// Token of a pbrt file.
struct PbrtToken {
  enum class Kind { end, word, text, open, close };  // word: directive or number; text: in quotes
  Kind kind = Kind::end;
  std::string_view text = {};  // without quotes; escapes are not resolved
  std::size_t line = 1;

  bool is(Kind of) const { return kind == of; }
};

// Divides a pbrt file into tokens: words, texts in quotes, brackets. Comments start with # and end with the
// line. The text must outlive the lexer and its tokens. Throws InputError with file and line.
class PbrtLexer {
 public:
  PbrtLexer(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

  PbrtToken next();
  // Returns the next token without moving past it.
  PbrtToken peek();
  ImportPlace place() const { return {file_, line_}; }
  ImportPlace place_of(const PbrtToken& token) const { return {file_, token.line}; }
  // Returns the number of a word. Throws InputError unless it is finite. `name` names it in the error.
  double number(const PbrtToken& word, std::string_view name) const;
  const std::string& file() const { return file_; }

 private:
  void skip_blanks();
  PbrtToken quoted();
  PbrtToken take(PbrtToken::Kind kind, std::size_t size);

  std::string_view rest_;
  std::string file_;
  std::size_t line_ = 1;
};

// Resolves the escapes of a text: \" \\ \n \t and others, which stand for the character after the backslash.
std::string unescaped(std::string_view text);

}  // namespace orrery
