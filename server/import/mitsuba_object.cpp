#include <cmath>

#include "core/base/number.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/mitsuba_xml.h"

namespace orrery {

const MitsubaProperty* MitsubaObject::find(std::string_view name) const {
  const auto found = properties.find(std::string(name));
  if (found == properties.end()) return nullptr;
  found->second.used = true;
  return &found->second;
}

double MitsubaObject::number(std::string_view name, double fallback) const {
  const MitsubaProperty* const found = find(name);
  if (found == nullptr) return fallback;
  const std::vector<double> numbers = numbers_of(found->text, found->place);
  if (numbers.size() != 1)
    refuse_at(found->place, std::string(name) + " must be a number (got " + excerpt(found->text) + ")");
  return numbers.front();
}

double MitsubaObject::positive(std::string_view name, double fallback) const {
  const double value = number(name, fallback);
  if (value >= kMinLength && value <= kMaxLength) return value;
  refuse_at(find(name) != nullptr ? find(name)->place : place,
            std::string(name) + " must be a number from 1e-12 to 1e12 (got " + number_text(value) + ")");
}

bool MitsubaObject::flag(std::string_view name, bool fallback) const {
  const MitsubaProperty* const found = find(name);
  if (found == nullptr) return fallback;
  const std::string word = lower_case(found->text);
  if (word != "true" && word != "false")
    refuse_at(found->place, std::string(name) + " must be true or false (got " + excerpt(found->text) + ")");
  return word == "true";
}

std::string MitsubaObject::text(std::string_view name, const std::string& fallback) const {
  const MitsubaProperty* const found = find(name);
  return found == nullptr ? fallback : found->text;
}

Vec3d MitsubaObject::point(std::string_view name, const Vec3d& fallback) const {
  const MitsubaProperty* const found = find(name);
  return found == nullptr ? fallback : found->map.origin;
}

Affined MitsubaObject::map(std::string_view name) const {
  const MitsubaProperty* const found = find(name);
  if (found == nullptr) return {};
  for (const Vec3d& v : {found->map.x, found->map.y, found->map.z, found->map.origin})
    if (!std::isfinite(dot(v, v)))
      refuse_at(found->place, "transformation must be finite (got a number past 1e154)");
  return found->map;
}

void MitsubaObject::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void MitsubaObject::note_unused(ImportNotes& notes) const {
  for (const auto& [name, one] : properties)
    if (!one.used)
      notes.add("property " + excerpt(name) + " of " + tag + " " + excerpt(type) + " has no effect");
}

}  // namespace orrery
