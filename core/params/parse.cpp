#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/params/document.h"
#include "core/params/json.h"
#include "core/params/words.h"

// Builds the tree through nlohmann's SAX interface. The DOM parser would keep the last of two equal keys,
// would apply no limits, and would report errors in programmers' terms.

namespace orrery {
namespace {

using nlohmann::json;

constexpr std::string_view kEndOfText = "the end of the text";

std::string in_plain_words(std::string text) {
  static constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"'[', '{', or a literal", "a value"},
      {"number literal", "a number"},
      {"string literal", "text in double quotes"},
      {"true literal", "true"},
      {"false literal", "false"},
      {"null literal", "null"},
      {"end of input", kEndOfText},
      {"ill-formed UTF-8 byte", "a byte that is not UTF-8"}};
  for (const auto& [theirs, ours] : kWords) {
    const std::size_t at = text.find(theirs);
    if (at != text.npos) text.replace(at, theirs.size(), ours);
  }
  return text;
}

// Rewrites "unexpected X; expected Y" as "must be Y (got X)". If Y is a closing bracket, returns "a comma or
// Y is missing before X", because a comma is valid there too and is forgotten more often. At the end of the
// text, only Y is reported as missing.
std::string in_our_grammar(const std::string& reason) {
  constexpr std::string_view kUnexpected = "unexpected ", kExpected = "; expected ";
  const std::size_t split = reason.find(kExpected);
  if (!reason.starts_with(kUnexpected) || split == reason.npos) return reason;
  const std::string allowed = reason.substr(split + kExpected.size());
  const std::string got = reason.substr(kUnexpected.size(), split - kUnexpected.size());
  if (allowed != "'}'" && allowed != "']'") return "must be " + allowed + " (got " + got + ")";
  return got == kEndOfText ? allowed + " is missing at " + std::string(kEndOfText)
                           : "a comma or " + allowed + " is missing before " + got;
}

// Returns the reason from nlohmann's message `what`: "[json.exception...] parse error at line 1, column 2:
// syntax error while parsing value - invalid literal; last read: '...'; expected ...". Everything from "last
// read" on is removed, because the quoted document text may be long or invalid UTF-8.
std::string reason_of(std::string_view what) {
  const std::size_t dash = what.find(" - ");
  const std::string_view reason = dash == what.npos ? what : what.substr(dash + 3);
  return in_our_grammar(in_plain_words(std::string(reason.substr(0, reason.find("; last read: ")))));
}

class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const JsonLimits& limits) : text_(text), limits_(limits) {}

  bool null() { return place(nullptr); }
  bool boolean(bool value) { return place(value); }
  bool number_integer(std::int64_t value) { return place(value); }
  bool number_unsigned(std::uint64_t value) { return place(value); }
  bool number_float(double value, const std::string&) { return place(value); }
  bool string(std::string& value) { return place(std::move(value)); }
  bool binary(json::binary_t&) { return false; }  // never called: JSON text has no binary values
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    Level& level = levels_.back();
    const auto [member, is_new] = level.container->get_ref<json::object_t&>().try_emplace(std::move(name));
    level.key = &member->first;
    level.slot = &member->second;
    if (!is_new) {
      problems_.push_back({pointer(), "duplicate key " + in_quotes(member->first)});
      if (problems_.size() == InputError::kMaxProblems) throw InputError(std::move(problems_));
    }
    return true;
  }

  [[noreturn]] bool parse_error(std::size_t position, const std::string& token,
                                const json::exception& error) {
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      problems_.push_back(
          {next_pointer(), "must be within the range of a double (got " + in_quotes(token) + ")"});
      throw InputError(std::move(problems_));
    }
    // `position` is the number of bytes read. The last byte read is the invalid character, or the last byte
    // of the unexpected token.
    const std::string_view what = error.what();
    const std::size_t last = position > 0 ? position - 1 : 0;
    fail(what.find(" - unexpected ") == what.npos ? last : token_start(last), reason_of(what));
  }

  void refuse_zero_bytes() {
    const std::size_t zero = text_.find('\0');  // nlohmann treats it as the end of the text
    if (zero != text_.npos) fail(zero, "JSON text must not contain a zero byte");
  }

  json finish() {
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(root_);
  }

 private:
  struct Level {  // unclosed array or object
    json* container;
    const std::string* key = nullptr;  // member being read; null in an array
    json* slot = nullptr;
  };

  bool place(json value) {
    put(std::move(value));
    return true;
  }

  bool open(json container) {
    if (levels_.size() == limits_.depth) {
      throw InputError(next_pointer(),
                       "JSON is nested too deeply (limit " + grouped(limits_.depth) + " levels, json_depth)");
    }
    json* placed = put(std::move(container));
    levels_.push_back({placed});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  json* put(json value) {
    checkpoint(nodes_);
    if (++nodes_ > limits_.nodes) {
      throw InputError(next_pointer(), "document has more than " + grouped(limits_.nodes) +
                                           " JSON values (limit " + grouped(limits_.nodes) + ", json_nodes)");
    }
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::move(value));
      return &level.container->back();
    }
    *level.slot = std::move(value);
    return level.slot;
  }

  // Returns the JSON Pointer of the value or key that was read last. In an array, this is the last element.
  std::string pointer() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.container->is_array()) {
        const std::size_t size = level.container->size();
        if (size > 0) text += "/" + std::to_string(size - 1);
      } else if (level.key) {
        text += pointer_step(*level.key);
      }
    }
    return text;
  }

  // Returns the JSON Pointer of the value that is read next.
  std::string next_pointer() const {
    if (levels_.empty() || !levels_.back().container->is_array()) return pointer();
    const std::size_t size = levels_.back().container->size();
    const std::string last = pointer();
    return (size == 0 ? last : last.substr(0, last.rfind('/'))) + "/" + std::to_string(size);
  }

  static bool in_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '+' || c == '-' || c == '.';
  }

  // Returns the offset of the first byte of the token whose last byte is at `last`.
  std::size_t token_start(std::size_t last) const {
    if (last >= text_.size()) return text_.size();
    std::size_t first = last;
    if (text_[last] == '"') {
      const auto escaped = [&](std::size_t i) {
        std::size_t slashes = 0;
        while (slashes < i && text_[i - 1 - slashes] == '\\') ++slashes;
        return slashes % 2 == 1;
      };
      do {
        if (first > 0) --first;
      } while (first > 0 && (text_[first] != '"' || escaped(first)));
    }
    while (in_word(text_[last]) && first > 0 && in_word(text_[first - 1])) --first;
    return first;
  }

  // Returns the word around `offset`, e.g. NaN, for the error text. Reads up to 40 bytes in each direction.
  std::string_view word_at(std::size_t offset) const {
    std::size_t first = offset, last = offset;
    while (first > 0 && offset - first < 40 && in_word(text_[first - 1])) --first;
    while (last < text_.size() && last - offset < 40 && in_word(text_[last])) ++last;
    return text_.substr(first, last - first);
  }

  [[noreturn]] void fail(std::size_t offset, std::string reason) const {
    offset = std::min(offset, text_.size());
    if (reason == "invalid literal" || reason.starts_with("invalid number")) {
      const std::string_view word = word_at(offset);
      reason = word.empty() ? "invalid character " + in_quotes(text_.substr(offset, 1))
                            : in_quotes(word) + " is not a JSON value";
      if (!word.empty()) offset = static_cast<std::size_t>(word.data() - text_.data());
    }
    const std::string_view before = text_.substr(0, offset);
    const std::size_t line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
    const std::size_t line_start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
    const std::size_t column = character_count(before.substr(line_start)) + 1;
    throw MalformedJson(next_pointer(), std::move(reason), offset, line, column);
  }

  std::string_view text_;
  JsonLimits limits_;
  json root_;
  std::vector<Level> levels_;
  std::size_t nodes_ = 0;
  std::vector<Problem> problems_;
};

}  // namespace

Document parse_document(std::string_view text, const JsonLimits& limits) {
  TreeBuilder builder(text, limits);
  builder.refuse_zero_bytes();
  const bool complete = json::sax_parse(text.begin(), text.end(), &builder);
  assert(complete);
  static_cast<void>(complete);
  return document_of(builder.finish());
}

}  // namespace orrery
