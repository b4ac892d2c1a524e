#include "core/meshes/xml_file.h"

#include <cmath>

#include "core/base/number.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::size_t kNodeBytes = 64, kAttributeBytes = 40;  // sizes in pugixml 1.13
constexpr std::string_view kBlanks = " \t\r\n";

struct XmlCounts {
  std::size_t elements = 0, attributes = 0;
};

// Counts the elements and attributes of a document and checks the limits. Other mistakes are left to the
// parser, which stops at the first one.
class XmlScanner {
 public:
  XmlScanner(std::string_view text, const std::string& name, const XmlLimits& limits)
      : text_(text), name_(name), limits_(limits) {}

  XmlCounts scan() {
    for (std::size_t at = text_.find('<'); at < text_.size(); at = text_.find('<', at)) {
      checkpoint();
      const std::string_view rest = text_.substr(at);
      if (rest.starts_with("<!--"))
        at = after("-->", at + 4);
      else if (rest.starts_with("<![CDATA["))
        at = after("]]>", at + 9);
      else if (rest.starts_with("<!"))
        fail_at(name_, "must not have a document type definition");
      else if (rest.starts_with("<?"))
        at = after("?>", at + 2);
      else if (rest.starts_with("</"))
        at = end_element(at);
      else
        at = start_element(at);
    }
    return counts_;
  }

 private:
  std::size_t after(std::string_view end, std::size_t from) const {
    const std::size_t at = text_.find(end, from);
    return at == text_.npos ? text_.size() : at + end.size();
  }

  std::size_t end_element(std::size_t at) {
    if (depth_ == 0) return text_.size();  // the parser stops here
    --depth_;
    return after(">", at);
  }

  std::size_t start_element(std::size_t at) {
    require(++counts_.elements, limits_.elements, "elements");
    std::size_t end = at + 1;
    for (; end < text_.size() && text_[end] != '>'; ++end) {
      if (text_[end] == '=') require(++counts_.attributes, limits_.attributes, "attributes");
      if (text_[end] == '"' || text_[end] == '\'')
        end = std::min(text_.find(text_[end], end + 1), text_.size());
    }
    if (end >= text_.size()) return text_.size();
    if (text_[end - 1] != '/') require(++depth_, limits_.depth, "levels of elements");
    return end + 1;
  }

  void require(std::size_t count, std::size_t limit, const char* what) const {
    if (count > limit) fail_at(name_, "must have at most " + grouped(limit) + " " + what + " (got more)");
  }

  std::string_view text_;
  const std::string& name_;
  const XmlLimits& limits_;
  XmlCounts counts_;
  std::size_t depth_ = 0;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace

std::string_view local_name(const char* name) {
  const std::string_view whole(name);
  return whole.substr(whole.rfind(':') + 1);  // npos + 1 is 0
}

XmlFile::XmlFile(std::string text, std::string name, const XmlLimits& limits)
    : text_(std::move(text)), name_(std::move(name)) {
  const XmlCounts counts = XmlScanner(text_, name_, limits).scan();
  // An element can have a node of text before it and one in it.
  charge_ = MemoryCharge(3 * kNodeBytes * counts.elements + kAttributeBytes * counts.attributes);
  const pugi::xml_parse_result result = document_.load_buffer_inplace(
      text_.data(), text_.size(), pugi::parse_minimal | pugi::parse_escapes, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
  if (!result)
    fail_at(name_, "must be XML in UTF-8 (got a mistake at byte " + std::to_string(result.offset) + ": " +
                       result.description() + ")");
}

std::optional<std::string_view> XmlFile::text(const pugi::xml_node& element, std::string_view name) {
  for (const pugi::xml_attribute& attribute : element.attributes())
    if (local_name(attribute.name()) == name) return attribute.value();
  return std::nullopt;
}

std::string_view XmlFile::needed_text(const pugi::xml_node& element, std::string_view name) const {
  const auto value = text(element, name);
  if (!value) fail(element, "must have the attribute " + excerpt(name));
  return *value;
}

std::optional<std::uint32_t> XmlFile::integer(const pugi::xml_node& element, std::string_view name) const {
  const auto value = text(element, name);
  if (!value) return std::nullopt;
  const auto number = parse_number<std::uint32_t>(trimmed(*value));
  if (!number)
    fail(element,
         std::string(name) + " must be an integer from 0 to 4294967295 (got " + excerpt(*value) + ")");
  return number;
}

std::uint32_t XmlFile::needed_integer(const pugi::xml_node& element, std::string_view name) const {
  needed_text(element, name);
  return *integer(element, name);
}

double XmlFile::needed_number(const pugi::xml_node& element, std::string_view name) const {
  const std::string_view value = needed_text(element, name);
  std::string_view digits = trimmed(value);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto number = parse_number<double>(digits);
  if (!number || !std::isfinite(*number))
    fail(element, std::string(name) + " must be a finite number (got " + excerpt(value) + ")");
  return *number;
}

void XmlFile::fail(const pugi::xml_node& element, const std::string& detail) const {
  fail_at(
      name_ + ", element " + excerpt(element.name()) + " at byte " + std::to_string(element.offset_debug()),
      detail);
}

}  // namespace orrery
