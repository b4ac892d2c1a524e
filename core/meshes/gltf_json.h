#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// A value of a glTF document that knows where it is, so that every refusal names the place. Lives no longer
// than the document.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  // Member `key` of this object; none, or an error, if it is missing.
  std::optional<GltfValue> find(const char* key) const;
  GltfValue at(const char* key) const;
  // Entries of this array.
  std::size_t size() const;
  GltfValue item(std::size_t i) const;  // fails if there are no more than i

  std::uint64_t integer() const;  // at least 0
  double number() const;
  bool flag() const;
  const std::string& text() const;

  // Throws InputError with the place.
  [[noreturn]] void fail(const std::string& detail) const;

 private:
  [[noreturn]] void fail_type(const char* expected) const;

  const nlohmann::json* value_;
  std::string path_;
};

// Integer `key` of an object, or `fallback` if it is missing.
std::uint64_t integer_or(const GltfValue& object, const char* key, std::uint64_t fallback);

// The parts of a glTF document that geometry needs, without extras and extensions. Throws InputError if the
// text is no JSON object, is nested deeper than any glTF or has too many values to hold.
nlohmann::json parse_gltf(std::string_view text);

}  // namespace orrery
