#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/meshes/xml_file.h"

namespace orrery {

// Element of an XML document, without its text.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;
  std::size_t line = 1;

  // Returns the attribute, or null if the element lacks it.
  const std::string* find(std::string_view attribute) const {
    for (const auto& [key, value] : attributes)
      if (key == attribute) return &value;
    return nullptr;
  }
  // Returns the attribute, or "" if the element lacks it.
  std::string text(std::string_view attribute) const {
    const std::string* const found = find(attribute);
    return found != nullptr ? *found : std::string();
  }
};

// Reads a document: see XmlFile for its limits and errors. Throws InputError, Cancelled and std::bad_alloc.
// Thread-safe.
XmlElement read_xml_tree(const std::string& text, const std::string& name, const XmlLimits& limits);

}  // namespace orrery
