#include "core/meshes/xml_tree.h"

#include <algorithm>

namespace orrery {
namespace {

// Converts the nodes of a document. Offsets of nodes are in document order, so lines are counted once.
class XmlTreeReader {
 public:
  explicit XmlTreeReader(std::string_view text) : text_(text) {}

  XmlElement read(const pugi::xml_node& node) {
    checkpoint();
    XmlElement element;
    element.name = node.name();
    element.line = line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)));
    for (const pugi::xml_attribute& attribute : node.attributes())
      element.attributes.emplace_back(attribute.name(), attribute.value());
    for_each_element(node, "", [&](const pugi::xml_node& child) { element.children.push_back(read(child)); });
    return element;
  }

 private:
  std::size_t line_at(std::size_t offset) {
    const std::size_t end = std::min(std::max(offset, counted_), text_.size());
    line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    counted_ = end;
    return line_;
  }

  std::string_view text_;
  std::size_t counted_ = 0, line_ = 1;
};

}  // namespace

XmlElement read_xml_tree(const std::string& text, const std::string& name, const XmlLimits& limits) {
  const XmlFile file(text, name, limits);
  return XmlTreeReader(text).read(file.root());
}

}  // namespace orrery
