#include "core/meshes/ply_header.h"

#include <array>
#include <string>

#include "core/base/shorten.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxProperties = 1000;  // elements plus properties; scanned meshes have about a dozen

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr TypeName kTypeNames[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

PlyType read_type(TextReader& text) {
  const std::string_view word = text.word_of_line();
  for (const auto& [name, type] : kTypeNames)
    if (name == word) return type;
  text.fail("must be a PLY type such as int or float32 (got " + excerpt(word) + ")");
}

PlyEncoding read_encoding(TextReader& text) {
  const std::string_view name = text.word_of_line(), version = text.word_of_line();
  if (version != "1.0") text.fail("must be version 1.0 (got " + excerpt(version) + ")");
  if (name == "ascii") return PlyEncoding::ascii;
  if (name == "binary_little_endian") return PlyEncoding::little_endian;
  if (name == "binary_big_endian") return PlyEncoding::big_endian;
  text.fail("must be one of ascii, binary_little_endian or binary_big_endian (got " + excerpt(name) + ")");
}

PlyElement read_element(TextReader& text) {
  const std::string_view name = text.word_of_line();
  const std::int64_t count = text.integer_in(text.word_of_line(), "number of elements");
  if (count < 0) text.fail("number of elements must be at least 0 (got " + std::to_string(count) + ")");
  return {name, static_cast<std::uint64_t>(count), {}};
}

PlyProperty read_property(TextReader& text) {
  TextReader ahead = text;
  if (ahead.word_of_line() != "list") {
    const PlyType type = read_type(text);
    return {text.word_of_line(), type};
  }
  text.word_of_line();
  const PlyType count_type = read_type(text);
  if (count_type == PlyType::float32 || count_type == PlyType::float64)
    text.fail("list length must have an integer type (got " + std::string(ahead.word_of_line()) + ")");
  const PlyType type = read_type(text);
  return {text.word_of_line(), type, count_type};
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(std::string_view bytes) {
  TextReader text(bytes);
  std::optional<PlyEncoding> encoding;
  std::vector<PlyElement> elements;
  std::size_t properties = 0, skipped_lines = 0;
  while (text.next_line()) {  // skips the line "ply"
    const std::string_view keyword = text.word_of_line();
    if (keyword == "end_header") {
      if (!encoding) text.fail("\"end_header\" must follow a line \"format\"");
      text.end_text(bytes.starts_with("ply\r") && !bytes.starts_with("ply\r\n"));
      return {*encoding, std::move(elements), text, skipped_lines};
    }
    if (keyword == "format") {
      encoding = read_encoding(text);
    } else if (keyword == "element") {
      elements.push_back(read_element(text));
    } else if (keyword == "property") {
      if (elements.empty()) text.fail("property must follow an element");
      elements.back().properties.push_back(read_property(text));
      ++properties;
    } else if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) {
      continue;
    } else if (encoding && elements.empty()) {
      ++skipped_lines;  // old exporters wrote comments without the keyword
    } else {
      text.fail("must be a PLY header keyword (got " + excerpt(keyword) + ")");
    }
    if (properties + elements.size() > kMaxProperties)
      text.fail("header has more than " + grouped(kMaxProperties) + " elements and properties (limit " +
                grouped(kMaxProperties) + ")");
  }
  text.fail("must be \"end_header\" (got the end of the file)");
}

}  // namespace orrery
