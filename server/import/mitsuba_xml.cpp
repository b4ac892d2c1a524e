#include "server/import/mitsuba_xml.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/number.h"
#include "core/base/task_scope.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/description_files.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxReplacedBytes = 1'000'000;  // size of an attribute with its $names replaced

// Returns int_ior for intIOR.
std::string snake_case(std::string_view name) {
  std::string snake;
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (is_upper(name[i]) && i > 0 && !is_upper(name[i - 1]) && name[i - 1] != '_') snake += '_';
    snake += name[i];
  }
  return lower_case(snake);
}

bool is_object(const XmlElement& element) {
  constexpr std::array<std::string_view, 19> kTags{"scene",      "shape",    "bsdf",   "emitter", "luminaire",
                                                   "sensor",     "camera",   "film",   "rfilter", "sampler",
                                                   "integrator", "texture",  "medium", "phase",   "volume",
                                                   "subsurface", "material", "group",  "object"};
  return std::find(kTags.begin(), kTags.end(), element.name) != kTags.end() ||
         (element.name == "spectrum" && element.find("type") != nullptr);
}

Vec3d coordinates(const XmlElement& element, const ImportPlace& place, double fallback) {
  if (const std::string* const value = element.find("value")) {
    const std::vector<double> n = numbers_of(*value, place);
    if (n.size() == 1) return Vec3d(n[0]);
    if (n.size() == 3) return {n[0], n[1], n[2]};
    refuse_at(place, "value must have three numbers (got " + excerpt(*value) + ")");
  }
  Vec3d at(fallback);
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i)
    if (const std::string* const text = element.find(kAxes[i])) {
      const std::vector<double> n = numbers_of(*text, place);
      if (n.size() != 1)
        refuse_at(place, std::string(kAxes[i]) + " must be a number (got " + excerpt(*text) + ")");
      at[i] = n[0];
    }
  return at;
}

Vec3d triple(const XmlElement& element, const char* name, const ImportPlace& place) {
  const std::string text = element.text(name);
  const std::vector<double> n = numbers_of(text, place);
  if (n.size() != 3)
    refuse_at(place, std::string(name) + " must have three numbers (got " + excerpt(text) + ")");
  return {n[0], n[1], n[2]};
}

Affined matrix(const XmlElement& element, const ImportPlace& place) {
  const std::vector<double> n = numbers_of(element.text("value"), place);
  if (n.size() == 9) return {{n[0], n[3], 0}, {n[1], n[4], 0}, {0, 0, 1}, {n[2], n[5], 0}};
  if (n.size() != 16)
    refuse_at(place, "matrix must have 9 or 16 numbers (got " + std::to_string(n.size()) + ")");
  if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1)
    refuse_at(place, "matrix must be affine: its last row must be 0 0 0 1 (got " + number_text(n[12]) + " " +
                         number_text(n[13]) + " " + number_text(n[14]) + " " + number_text(n[15]) + ")");
  return {{n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}, {n[3], n[7], n[11]}};
}

Affined step_of(const XmlElement& element, const ImportPlace& place) {
  const std::string name = snake_case(element.name);
  if (name == "translate") return translation(coordinates(element, place, 0));
  if (name == "scale") return scaling(coordinates(element, place, 1));
  if (name == "matrix") return matrix(element, place);
  if (name == "rotate") {
    const Vec3d axis = safe_normalize(coordinates(element, place, 0));
    const std::vector<double> n = numbers_of(element.text("angle"), place);
    if (axis == Vec3d(0, 0, 0) || n.size() != 1)
      refuse_at(place, "rotate must have an axis that is not 0, and an angle");
    return rotation(axis, std::fmod(n[0], 360));
  }
  if (name == "lookat" || name == "look_at") {
    const Vec3d up = element.find("up") != nullptr ? triple(element, "up", place) : Vec3d(0, 1, 0);
    const Affined map = looking_at(triple(element, "origin", place), triple(element, "target", place), up);
    if (scaled_determinant(map) == 0)
      refuse_at(place, "lookat must have two different points and a direction up that is not along the view");
    return map;
  }
  refuse_at(place, "transform must have steps translate, scale, rotate, lookat or matrix (got " +
                       excerpt(element.name) + ")");
}

}  // namespace

std::vector<double> numbers_of(const std::string& text, const ImportPlace& place) {
  constexpr std::string_view kSeparators = " \t\r\n,";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kSeparators); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kSeparators, at), text.size());
    std::string_view word = std::string_view(text).substr(at, end - at);
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto number = parse_number<double>(word);
    if (!number || !std::isfinite(*number))
      refuse_at(place, "value must be a finite number (got " + excerpt(word) + ")");
    numbers.push_back(*number);
    at = text.find_first_not_of(kSeparators, end);
  }
  return numbers;
}

// Converts elements to objects.
class MitsubaXmlReader {
 public:
  MitsubaXmlReader(MitsubaDocument& document, const ReadNearby& nearby, const ImportLimits& limits)
      : document_(document), files_(nearby, limits) {}

  // Returns the root of a file.
  std::shared_ptr<MitsubaObject> read_file(const std::string& text, const std::string& name) {
    files_.count(text, name);
    XmlElement root;
    try {
      root = read_xml_tree(text, "document", {});
    } catch (const InputError& error) {
      throw InputError(name, error.problems().front().detail);
    }
    const std::string before = std::exchange(file_, name);
    if (!is_object(root))
      refuse_at(place_of(root), "root of the document must be a scene (got " + excerpt(root.name) + ")");
    auto object = read_object(root);
    file_ = before;
    return object;
  }

 private:
  ImportPlace place_of(const XmlElement& element) const { return {file_, element.line}; }

  // Replaces $names by the values of <default>.
  std::string resolved(const std::string& text, const ImportPlace& place) const {
    std::string plain;
    for (std::size_t i = 0; i < text.size();) {
      if (text[i] != '$') {
        plain += text[i++];
        continue;
      }
      std::size_t end = i + 1;
      while (end < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
        ++end;
      const auto found = defaults_.find(text.substr(i + 1, end - i - 1));
      if (found == defaults_.end())
        refuse_at(place, "parameter must have a <default> (got " + excerpt(text.substr(i, end - i)) + ")");
      plain += found->second;
      if (plain.size() > kMaxReplacedBytes)
        refuse_at(place, "value must have at most 1,000,000 bytes (got more)");
      i = end;
    }
    return plain;
  }
  XmlElement resolved(const XmlElement& element) const {
    XmlElement plain{element.name, element.attributes, {}, element.line};
    for (auto& [name, value] : plain.attributes)
      if (value.find('$') != value.npos) value = resolved(value, place_of(element));
    return plain;
  }

  std::shared_ptr<MitsubaObject> read_object(const XmlElement& element) {
    checkpoint();
    const XmlElement own = resolved(element);
    auto object = std::make_shared<MitsubaObject>();
    object->tag = own.name == "luminaire" ? "emitter" : own.name == "camera" ? "sensor" : own.name;
    object->type = own.text("type");
    object->id = own.text("id");
    object->place = place_of(own);
    for (const XmlElement& child : element.children) read_member(*object, child);
    if (!object->id.empty()) document_.by_id_[object->id] = object;
    return object;
  }

  void read_member(MitsubaObject& parent, const XmlElement& element) {
    const XmlElement own = resolved(element);
    const ImportPlace place = place_of(own);
    if (is_object(own)) {
      parent.children.push_back({snake_case(own.text("name")), read_object(element), ""});
    } else if (own.name == "ref") {
      parent.children.push_back({snake_case(own.text("name")), nullptr, own.text("id")});
    } else if (own.name == "default") {
      defaults_.try_emplace(own.text("name"), own.text("value"));
    } else if (own.name == "alias") {
      const auto found = document_.by_id_.find(own.text("id"));
      if (found == document_.by_id_.end())
        refuse_at(place, "alias must name an object that is defined before it (got " +
                             excerpt(own.text("id")) + ")");
      document_.by_id_[own.text("as")] = found->second;
    } else if (own.name == "include") {
      include(parent, own.text("filename"), place);
    } else if (own.name != "path") {
      parent.properties[snake_case(own.text("name"))] = property(own, element, place);
    }
  }

  MitsubaProperty property(const XmlElement& own, const XmlElement& with_children,
                           const ImportPlace& place) const {
    constexpr std::array<std::string_view, 12> kTags{"float",    "integer",   "boolean",   "string",
                                                     "point",    "vector",    "rgb",       "srgb",
                                                     "spectrum", "blackbody", "transform", "color"};
    if (std::find(kTags.begin(), kTags.end(), own.name) == kTags.end())
      refuse_at(place,
                "element must be one of Mitsuba's, such as float or shape (got " + excerpt(own.name) + ")");
    MitsubaProperty read{.tag = own.name, .text = "", .place = place};
    for (const char* const key : {"value", "filename", "temperature"})
      if (const std::string* const value = own.find(key)) {
        read.text = *value;
        if (key == std::string_view("filename")) read.tag = "spectrum file";
      }
    if (own.name == "point" || own.name == "vector") read.map.origin = coordinates(own, place, 0);
    if (const std::string* const scale = own.find("scale")) {
      const std::vector<double> n = numbers_of(*scale, place);
      read.scale = n.empty() ? 1 : n[0];
    }
    if (own.name == "transform")
      for (const XmlElement& step : with_children.children)
        read.map = compose(step_of(resolved(step), place_of(step)), read.map);
    return read;
  }

  void include(MitsubaObject& parent, const std::string& name, const ImportPlace& place) {
    const auto root = read_file(files_.begin_include(name, place), name);
    if (root->tag == "scene") {
      parent.children.insert(parent.children.end(), root->children.begin(), root->children.end());
      parent.properties.insert(root->properties.begin(), root->properties.end());
    } else {
      parent.children.push_back({"", root, ""});
    }
    files_.end_include();
  }

  MitsubaDocument& document_;
  DescriptionFiles files_;
  std::string file_;
  std::map<std::string, std::string> defaults_;
};

MitsubaDocument::MitsubaDocument(const std::string& text, const std::string& name, const ReadNearby& nearby,
                                 const ImportLimits& limits) {
  scene_ = MitsubaXmlReader(*this, nearby, limits).read_file(text, name);
}

const MitsubaObject& MitsubaDocument::object_of(const MitsubaObject::Child& child,
                                                const ImportPlace& place) const {
  if (child.object != nullptr) return *child.object;
  const auto found = by_id_.find(child.ref);
  if (found == by_id_.end())
    refuse_at(place, "ref must name an object of the scene (got " + excerpt(child.ref) + ")");
  return *found->second;
}

std::vector<const MitsubaObject*> MitsubaDocument::children(const MitsubaObject& parent,
                                                            std::string_view tag) const {
  std::vector<const MitsubaObject*> found;
  for (const MitsubaObject::Child& child : parent.children) {
    const MitsubaObject& object = object_of(child, parent.place);
    if (object.tag == tag) found.push_back(&object);
  }
  return found;
}

const MitsubaObject* MitsubaDocument::child(const MitsubaObject& parent, std::string_view tag) const {
  const std::vector<const MitsubaObject*> found = children(parent, tag);
  return found.empty() ? nullptr : found.front();
}

const MitsubaObject* MitsubaDocument::named_child(const MitsubaObject& parent, std::string_view name) const {
  for (const MitsubaObject::Child& child : parent.children)
    if (child.name == name) return &object_of(child, parent.place);
  return nullptr;
}

}  // namespace orrery
