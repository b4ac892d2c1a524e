#include "core/meshes/gltf_json.h"

#include <algorithm>

#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr int kMaxDepth = 32;                  // geometry needs 6
constexpr std::size_t kMaxValues = 1'000'000;  // 16 to 80 bytes of memory each, 2 bytes of text or more

constexpr std::string_view kTopKeys[] = {"asset",       "scene",   "scenes",
                                         "nodes",       "meshes",  "accessors",
                                         "bufferViews", "buffers", "extensionsRequired"};

}  // namespace

std::optional<GltfValue> GltfValue::find(const char* key) const {
  if (!value_->is_object()) fail_type("an object");
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return GltfValue(*found, path_ + '/' + key);
}

GltfValue GltfValue::at(const char* key) const {
  const auto found = find(key);
  if (!found) fail(std::string("expected a member \"") + key + "\", got none");
  return *found;
}

std::size_t GltfValue::size() const {
  if (!value_->is_array()) fail_type("an array");
  return value_->size();
}

GltfValue GltfValue::item(std::size_t i) const {
  if (i >= size())
    fail("expected entry " + std::to_string(i) + ", got " + std::to_string(size()) + " entries");
  return {(*value_)[i], path_ + '/' + std::to_string(i)};
}

std::uint64_t GltfValue::integer() const {
  if (!value_->is_number_unsigned()) fail_type("an integer of at least 0");
  return value_->get<std::uint64_t>();
}

double GltfValue::number() const {
  if (!value_->is_number()) fail_type("a number");
  return value_->get<double>();
}

bool GltfValue::flag() const {
  if (!value_->is_boolean()) fail_type("true or false");
  return value_->get<bool>();
}

const std::string& GltfValue::text() const {
  if (!value_->is_string()) fail_type("a string");
  return value_->get_ref<const std::string&>();
}

void GltfValue::fail(const std::string& detail) const { fail_at(path_.empty() ? "/" : path_, detail); }

void GltfValue::fail_type(const char* expected) const {
  const std::string got = value_->is_structured() ? value_->type_name() : value_->dump();
  fail(std::string("expected ") + expected + ", got " + (got.size() > 40 ? value_->type_name() : got));
}

std::uint64_t integer_or(const GltfValue& object, const char* key, std::uint64_t fallback) {
  const auto value = object.find(key);
  return value ? value->integer() : fallback;
}

nlohmann::json parse_gltf(std::string_view text) {
  using Event = nlohmann::json::parse_event_t;
  std::size_t values = 0;
  // Returns false for values that the document leaves out.
  const auto keep = [&](int depth, Event event, const nlohmann::json& value) {
    if (depth > kMaxDepth)
      throw InputError("", "expected JSON nested at most " + std::to_string(kMaxDepth) + " deep, got more");
    if (event != Event::key) {
      values += event != Event::object_end && event != Event::array_end;
      if (values > kMaxValues)
        throw InputError("", "expected at most " + std::to_string(kMaxValues) + " JSON values, got more");
      return true;
    }
    const auto& key = value.get_ref<const std::string&>();
    if (depth == 1) return std::find(std::begin(kTopKeys), std::end(kTopKeys), key) != std::end(kTopKeys);
    return key != "extras" && key != "extensions";
  };
  try {
    nlohmann::json document = nlohmann::json::parse(text.begin(), text.end(), keep);
    if (!document.is_object()) throw InputError("", "expected a glTF document as a JSON object, got none");
    return document;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("", "expected a glTF document in JSON, got " + excerpt(error.what(), 160));
  }
}

}  // namespace orrery
