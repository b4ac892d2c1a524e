#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/meshes/xml_tree.h"
#include "server/import/import.h"
#include "server/import/notes.h"
#include "server/import/place.h"
#include "server/import/placement.h"

namespace orrery {

// Property of a Mitsuba object, such as <float name="radius" value="2"/>.
struct MitsubaProperty {
  std::string
      tag;  // float, integer, boolean, string, point, vector, rgb, srgb, spectrum, blackbody, transform
  std::string text;  // attribute "value", or "filename" of a spectrum
  Affined map = {};  // transform, or its origin: point or vector
  double scale = 1;  // factor of a blackbody
  ImportPlace place = {};
  mutable bool used = false;
};

// Object of a Mitsuba scene: shape, bsdf, emitter and others. Names of properties are in snake case, so those
// of version 0.6 equal those of later versions: toWorld is to_world.
struct MitsubaObject {
  std::string tag, type, id;
  ImportPlace place;
  std::map<std::string, MitsubaProperty> properties = {};
  struct Child {
    std::string name;                             // role, or ""
    std::shared_ptr<const MitsubaObject> object;  // or null
    std::string ref;                              // id of the object
  };
  std::vector<Child> children = {};

  // Getters return the value of a property, or the fallback. Throw InputError with file, line, value and
  // limit.
  const MitsubaProperty* find(std::string_view name) const;
  double number(std::string_view name, double fallback) const;
  double positive(std::string_view name, double fallback) const;
  bool flag(std::string_view name, bool fallback) const;
  std::string text(std::string_view name, const std::string& fallback) const;
  Vec3d point(std::string_view name, const Vec3d& fallback) const;
  Affined map(std::string_view name = "to_world") const;
  // Marks properties without an effect on the image.
  void ignore(std::initializer_list<std::string_view> names) const;
  // Adds notes about properties that no getter was called for.
  void note_unused(ImportNotes& notes) const;
};

// Reads a scene with the files that it includes. Resolves <default>, <alias>, <include> and $names.
class MitsubaDocument {
 public:
  MitsubaDocument(const std::string& text, const std::string& name, const ReadNearby& nearby,
                  const ImportLimits& limits);

  const MitsubaObject& scene() const { return *scene_; }
  // Returns the object of a child. Throws InputError if there is no object with its id.
  const MitsubaObject& object_of(const MitsubaObject::Child& child, const ImportPlace& place) const;
  // Returns the first child with one of the tags, or null.
  const MitsubaObject* child(const MitsubaObject& parent, std::string_view tag) const;
  const MitsubaObject* named_child(const MitsubaObject& parent, std::string_view name) const;
  std::vector<const MitsubaObject*> children(const MitsubaObject& parent, std::string_view tag) const;

 private:
  friend class MitsubaXmlReader;
  std::shared_ptr<const MitsubaObject> scene_;
  std::map<std::string, std::shared_ptr<const MitsubaObject>> by_id_;
};

// Returns the numbers of a text, separated by blanks or commas. Throws InputError unless all are finite.
std::vector<double> numbers_of(const std::string& text, const ImportPlace& place);

}  // namespace orrery
