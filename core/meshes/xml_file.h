#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "core/base/task_scope.h"

namespace orrery {

// Limits on an XML document.
struct XmlLimits {
  std::size_t elements = 1'000'000;
  std::size_t attributes = 4'000'000;
  std::size_t depth = 100;  // nested elements, which pugixml visits recursively
};

// XML document in UTF-8 without a document type definition. Functions that take a name compare it with the
// part of names after the prefix, because files choose the prefixes of namespaces. Functions throw InputError
// with the place. Thread-safe once read.
class XmlFile {
 public:
  // Parses `text`. `name` names the document in errors. Checks the limits before the parser allocates memory.
  // Throws InputError, Cancelled and std::bad_alloc.
  XmlFile(std::string text, std::string name, const XmlLimits& limits);
  XmlFile(const XmlFile&) = delete;

  pugi::xml_node root() const { return document_.document_element(); }

  // Returns the attribute, or nullopt if the element lacks it.
  static std::optional<std::string_view> text(const pugi::xml_node& element, std::string_view name);
  // Returns a non-negative integer below 2^32, or nullopt if the element lacks the attribute.
  std::optional<std::uint32_t> integer(const pugi::xml_node& element, std::string_view name) const;
  // Return an attribute that the element must have.
  std::string_view needed_text(const pugi::xml_node& element, std::string_view name) const;
  std::uint32_t needed_integer(const pugi::xml_node& element, std::string_view name) const;
  double needed_number(const pugi::xml_node& element, std::string_view name) const;

  [[noreturn]] void fail(const pugi::xml_node& element, const std::string& detail) const;

 private:
  std::string text_;  // the document refers to it
  std::string name_;
  MemoryCharge charge_;  // memory of the document
  pugi::xml_document document_;
};

// Returns the name without the prefix of its namespace.
std::string_view local_name(const char* name);

// Calls visit(child) for the child elements with a name, or for all of them if `name` is empty. Throws
// Cancelled.
template <class Visit>
void for_each_element(const pugi::xml_node& parent, std::string_view name, const Visit& visit) {
  for (const pugi::xml_node& child : parent.children()) {
    checkpoint();
    if (child.type() == pugi::node_element && (name.empty() || local_name(child.name()) == name))
      visit(child);
  }
}

}  // namespace orrery
