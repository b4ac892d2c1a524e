#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "core/math/vec3.h"

// Conversion of numbers, points and JSON members for the parts of povray_scene().
namespace orrery::povray {

using Json = nlohmann::json;

inline std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", x);
  return buffer;
}
inline std::string text(const Vec3d& v) {
  return "<" + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + ">";
}

inline Vec3d vector_of(const Json& numbers) { return {numbers.at(0), numbers.at(1), numbers.at(2)}; }
inline Vec3d vector_of(const Json& object, const char* key) { return vector_of(object.at(key)); }
inline Vec3d vector_of(const Json& object, const char* key, const Vec3d& otherwise) {
  return object.contains(key) ? vector_of(object.at(key)) : otherwise;
}
// Returns a coefficient: one number for all channels, or a colour.
inline Vec3d coefficient_of(const Json& object, const char* key, const Vec3d& otherwise) {
  if (!object.contains(key)) return otherwise;
  const Json& value = object.at(key);
  return value.is_number() ? Vec3d(value.get<double>()) : vector_of(value);
}

// POV-Ray modifiers for an object with a material. `transparent` is true if light passes through the object.
struct Material {
  std::string modifiers;
  bool transparent;
};
Material material_of(const Json& material, const Json& textures);

// Returns the pigment of a parameter that uses a texture, multiplied by `factor`.
std::string pigment_of(const Json& use, const Json& textures, const Vec3d& factor);

// Returns the object without its closing brace, so that modifiers can follow.
std::string shape_of(const Json& object);

// Returns the modifier that places a model as an instance.
std::string placement_of(const Json& instance);

std::string light_of(const Json& light, double exposure);

}  // namespace orrery::povray
