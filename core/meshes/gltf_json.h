#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace orrery {

// Value of a glTF document, with its path for error messages. Must not outlive the document. Each function
// throws InputError if the value does not have the JSON type that the function needs.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  // Returns member `key` of this object. If the member is missing, find() returns nullopt and at() throws.
  std::optional<GltfValue> find(const char* key) const;
  GltfValue at(const char* key) const;
  // Returns the number of entries of this array.
  std::size_t size() const;
  GltfValue item(std::size_t i) const;  // throws if i >= size()

  std::uint64_t integer() const;  // throws if negative
  double number() const;
  bool flag() const;
  const std::string& text() const;

  // Throws InputError with the path of this value.
  [[noreturn]] void fail(const std::string& detail) const;

 private:
  [[noreturn]] void fail_type(const char* expected) const;

  const nlohmann::json* value_;
  std::string path_;
};

// Returns the integer at `key` of an object, or `fallback` if the key is missing. Throws InputError if the
// value is not an integer of at least 0.
std::uint64_t integer_or(const GltfValue& object, const char* key, std::uint64_t fallback);

// Returns the extension `name` of an object, or nullopt if the object does not use it.
std::optional<GltfValue> extension_of(const GltfValue& object, const char* name);

// Parses the parts of a glTF document that models need, without extras. Throws InputError
// if the text is not a valid JSON object, or if it has more than 32 levels or 1,000,000 values. Throws
// Cancelled.
nlohmann::json parse_gltf(std::string_view text);

}  // namespace orrery
