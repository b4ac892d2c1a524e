#include "core/meshes/gltf_json.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxDepth = 32;          // levels; geometry needs 6
constexpr std::size_t kMaxValues = 1'000'000;  // a value takes 16 to 80 bytes of memory

constexpr std::string_view kTopKeys[] = {"asset", "scene", "scenes", "nodes", "meshes", "accessors",
                                         "bufferViews", "buffers", "extensionsRequired", "materials",
                                         "textures", "images", "samplers", "cameras", "skins", "extensions",
                                         // Only for notes:
                                         "extensionsUsed", "animations"};

// Builds the document from parser events. Skips the values that neither geometry nor notes need. nlohmann's
// callback parser would take quadratic time, because it searches a container for discarded values after each
// element.
class GltfBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  nlohmann::json& document() { return document_; }
  std::size_t error_position() const { return error_position_; }  // in bytes

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // not part of JSON text
  bool start_object(std::size_t) override { return open(nlohmann::json::object()); }
  bool start_array(std::size_t) override { return open(nlohmann::json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    check_depth();
    if (skipped_ > 0) return true;
    const bool is_top = depth() == 1;
    skips_next_ = is_top ? std::find(std::begin(kTopKeys), std::end(kTopKeys), name) == std::end(kTopKeys)
                         : name == "extras";
    key_ = std::move(name);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception&) override {
    error_position_ = position;
    return false;
  }

 private:
  // Adds a value to the innermost open container. Returns true, so that parsing continues.
  bool add(nlohmann::json value) {
    count_value();
    if (skipped_ == 0 && !std::exchange(skips_next_, false)) place(std::move(value));
    return true;
  }
  bool open(nlohmann::json container) {
    count_value();
    if (skipped_ > 0 || std::exchange(skips_next_, false))
      ++skipped_;
    else
      open_.push_back(&place(std::move(container)));
    return true;
  }
  bool close() {
    if (skipped_ > 0)
      --skipped_;
    else
      open_.pop_back();
    return true;
  }
  nlohmann::json& place(nlohmann::json value) {
    if (open_.empty()) return document_ = std::move(value);
    nlohmann::json& parent = *open_.back();
    if (parent.is_object()) return parent[key_] = std::move(value);
    parent.push_back(std::move(value));
    return parent.back();
  }
  std::size_t depth() const { return open_.size() + skipped_; }
  void check_depth() const {
    if (depth() > kMaxDepth)
      throw InputError("", "JSON is nested too deeply (limit " + std::to_string(kMaxDepth) + " levels)");
  }
  void count_value() {
    check_depth();
    checkpoint(values_++);
    if (values_ > kMaxValues)
      throw InputError("", "document has more than " + grouped(kMaxValues) + " JSON values (limit " +
                               grouped(kMaxValues) + ")");
  }

  nlohmann::json document_;
  std::vector<nlohmann::json*> open_;  // containers from the root to the innermost
  std::string key_;                    // key of the next value
  bool skips_next_ = false;            // true if the next value is skipped
  std::size_t skipped_ = 0;            // number of open containers that are not stored
  std::size_t values_ = 0, error_position_ = 0;
};

}  // namespace

std::optional<GltfValue> GltfValue::find(const char* key) const {
  if (!value_->is_object()) fail_type("an object");
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return GltfValue(*found, path_ + '/' + key);
}

GltfValue GltfValue::at(const char* key) const {
  const auto found = find(key);
  if (!found) fail(std::string("missing key \"") + key + "\"");
  return *found;
}

std::size_t GltfValue::size() const {
  if (!value_->is_array()) fail_type("an array");
  return value_->size();
}

GltfValue GltfValue::item(std::size_t i) const {
  if (i >= size())
    fail("must have entry " + std::to_string(i) + " (got " + std::to_string(size()) +
         (size() == 1 ? " entry)" : " entries)"));
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

void GltfValue::fail_type(const char* allowed) const {
  const std::string got = value_->is_structured() ? value_->type_name() : value_->dump();
  fail(std::string("must be ") + allowed + " (got " + (got.size() > 40 ? value_->type_name() : got) + ")");
}

std::uint64_t integer_or(const GltfValue& object, const char* key, std::uint64_t fallback) {
  const auto value = object.find(key);
  return value ? value->integer() : fallback;
}

std::optional<GltfValue> extension_of(const GltfValue& object, const char* name) {
  const auto extensions = object.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

nlohmann::json parse_gltf(std::string_view text) {
  GltfBuilder builder;
  const bool complete = nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  if (!complete)
    throw InputError("", "JSON syntax error at byte " + std::to_string(builder.error_position()));
  if (!builder.document().is_object()) throw InputError("", "document must be a JSON object");
  return std::move(builder.document());
}

}  // namespace orrery
