#include "core/params/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/shorten.h"

namespace orrery {
namespace {

constexpr std::size_t kBriefCharacters = 40;

std::string shortest(double x) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, end);
}

void append_number(double x, std::string& out) {
  if (x == std::trunc(x) && std::abs(x) <= kMaxInteger) {
    out += std::to_string(static_cast<long long>(x));  // turns -0 into 0
  } else {
    out += shortest(x);
  }
}

void append_string(std::string_view text, std::string& out, std::size_t limit) {
  static constexpr char kDigits[] = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    if (out.size() > limit) return;
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20) {
      out += "\\u00";
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

// Truncates a text longer than kBriefCharacters characters and appends "...".
std::string cut(std::string text) {
  const std::size_t first = first_characters(text, kBriefCharacters).size();
  if (first == text.size()) return text;
  text.resize(first);
  return text + "...";
}

}  // namespace

std::string number_text(double x) {
  std::string text = shortest(x);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  const std::string sign = text[e + 1] == '-' ? "-" : "";
  const std::size_t digits = text.find_first_not_of("+-0", e + 1);
  return text.substr(0, e) + "e" + sign + text.substr(digits);
}

void append_canonical(const nlohmann::json& value, std::string& out, std::size_t limit) {
  using nlohmann::json;
  if (out.size() > limit) return;
  switch (value.type()) {
    case json::value_t::object: {
      char separator = '{';
      for (const auto& [key, member] : value.get_ref<const json::object_t&>()) {
        if (out.size() > limit) return;
        out += separator;
        append_string(key, out, limit);
        out += ':';
        append_canonical(member, out, limit);
        separator = ',';
      }
      out += value.empty() ? "{}" : "}";
      break;
    }
    case json::value_t::array: {
      char separator = '[';
      for (const json& element : value) {
        if (out.size() > limit) return;
        out += separator;
        append_canonical(element, out, limit);
        separator = ',';
      }
      out += value.empty() ? "[]" : "]";
      break;
    }
    case json::value_t::string: append_string(value.get_ref<const std::string&>(), out, limit); break;
    case json::value_t::boolean: out += value.get<bool>() ? "true" : "false"; break;
    case json::value_t::number_integer:
    case json::value_t::number_unsigned:
      if (std::abs(value.get<double>()) >= kMaxInteger) {  // a double may round the integer
        out += value.dump();
        break;
      }
      [[fallthrough]];
    case json::value_t::number_float: append_number(value.get<double>(), out); break;
    default: out += "null";
  }
}

std::string brief(const nlohmann::json& value) {
  std::string text;
  append_canonical(value, text, 4 * kBriefCharacters + 8);  // at most 4 bytes per UTF-8 character
  return cut(std::move(text));
}

std::string in_quotes(std::string_view name) {
  std::string text;
  append_string(name, text, 4 * kBriefCharacters + 8);
  return cut(std::move(text));
}

std::string one_of(std::span<const std::string_view> words, std::string_view last_join) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last_join : ", ";
    text += in_quotes(words[i]);
  }
  return text;
}

std::string choice_text(std::span<const std::string_view> words) {
  return (words.size() > 2 ? "one of " : "") + one_of(words);
}

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char c : shortened(key)) {
    if (c == '~') {
      step += "~0";
    } else if (c == '/') {
      step += "~1";
    } else {
      step += c;
    }
  }
  return step;
}

std::string range_text(const Range& range) {
  const bool has_min = std::isfinite(range.min), has_max = std::isfinite(range.max);
  if (has_min && has_max && !range.exclusive_min && !range.exclusive_max)
    return " from " + number_text(range.min) + " to " + number_text(range.max);
  std::string text;
  if (has_min) text += (range.exclusive_min ? " > " : " of at least ") + number_text(range.min);
  if (has_max) {
    if (has_min) text += " and";
    text += (range.exclusive_max ? " < " : " of at most ") + number_text(range.max);
  }
  return text;
}

std::string count_text(Count count) {
  if (count.min == count.max) return std::to_string(count.min);
  if (count.max == Count{}.max) return "at least " + std::to_string(count.min);
  if (count.min == 0) return "at most " + std::to_string(count.max);
  return std::to_string(count.min) + " to " + std::to_string(count.max);
}

double stand_in(const Range& range) {
  for (const double x : {0.0, 1.0, range.min, range.max, (range.min + range.max) / 2}) {
    if (std::isfinite(x) && range.contains(x)) return x;
  }
  return std::isfinite(range.min) ? range.min + 1 : range.max - 1;
}

}  // namespace orrery
