#include "core/params/describer.h"

#include <cassert>
#include <cmath>

#include "core/params/words.h"

namespace orrery {
namespace {

// Returns an integer for integral values up to 2^53, so that the schema shows 600 and not 600.0.
Schema number_of(double x) {
  const bool exact = x == std::trunc(x) && std::abs(x) <= 9007199254740992.0;
  return exact ? Schema(static_cast<std::int64_t>(x)) : Schema(x);
}

Schema value_of(double x) { return number_of(x); }
Schema value_of(std::int64_t x) { return x; }
Schema value_of(bool x) { return x; }
Schema value_of(std::string_view x) { return x; }
Schema value_of(const Vec3d& v) { return Schema::array({number_of(v.x), number_of(v.y), number_of(v.z)}); }

Schema number_schema(const char* type, const Range& range) {
  Schema schema = {{"type", type}};
  if (std::isfinite(range.min))
    schema[range.exclusive_min ? "exclusiveMinimum" : "minimum"] = number_of(range.min);
  if (std::isfinite(range.max))
    schema[range.exclusive_max ? "exclusiveMaximum" : "maximum"] = number_of(range.max);
  return schema;
}

Schema one_of_schema(std::span<const std::string_view> words) {
  return {{"enum", std::vector<std::string>(words.begin(), words.end())}};
}

Schema list_schema(Schema items, Count count) {
  Schema schema = {{"type", "array"}, {"items", std::move(items)}};
  if (count.min > 0) schema["minItems"] = count.min;
  if (count.max != Count{}.max) schema["maxItems"] = count.max;
  return schema;
}

Schema three_numbers(const char* type, const Range& range) {
  return list_schema(number_schema(type, range), {.min = 3, .max = 3});
}

constexpr const char* kBeyond =
    " The program also checks conditions that a schema cannot express: names must exist, certain "
    "points must be distinct, and vertex indices must be less than the number of positions.";

const Schema kEmptyList = Schema::array();
const Schema kEmptyObject = Schema::object();

// Returns the default of a list or map in the schema: `empty`, or null if the list or map is required.
const Schema* if_empty_allowed(Count count, const Schema& empty) { return count.min == 0 ? &empty : nullptr; }

}  // namespace

Schema Describer::describe_object(const Read& read, Schema& definitions) {
  Choices choices;
  Schema ways = Schema::array();
  do {
    Describer way(choices, definitions);
    read(way);
    ways.push_back(way.finish());
  } while (choices.advance());
  if (ways.size() == 1) return ways[0];
  return {{"type", "object"}, {"oneOf", std::move(ways)}};
}

Schema Describer::finish() {
  Schema schema = Schema::object();
  if (!title_.empty()) schema["title"] = title_;
  if (!summary_.empty()) schema["description"] = summary_;
  schema["type"] = "object";
  schema["properties"] = std::move(properties_);
  if (!required_.empty()) schema["required"] = std::move(required_);
  schema["additionalProperties"] = false;
  return schema;
}

void Describer::add(Key key, Doc doc, Schema schema, bool required, const Schema* fallback) {
  const std::string name(key);
  assert(!properties_.contains(name));
  if (required) required_.push_back(name);
  Schema property = Schema::object();
  if (!doc.empty()) property["description"] = doc;
  if (instead_.contains(name)) {
    Schema ways = schema.contains("anyOf") ? schema["anyOf"] : Schema::array({schema});
    ways.push_back(instead_[name]);
    schema = {{"anyOf", std::move(ways)}};
  }
  property.update(schema);
  if (fallback) property["default"] = *fallback;
  properties_[name] = std::move(property);
}

template <class T>
void Describer::add(Key key, Doc doc, Schema schema, const Fallback<T>& fallback) {
  Schema written;
  if (fallback.value) written = value_of(*fallback.value);
  const bool write = fallback.value && fallback.in_schema;
  add(key, doc, std::move(schema), !fallback.value, write ? &written : nullptr);
}

double Describer::do_number(Key key, Doc doc, const Range& range, const Fallback<double>& fallback) {
  add(key, doc, number_schema("number", range), fallback);
  return fallback.value.value_or(stand_in(range));
}

std::int64_t Describer::do_integer(Key key, Doc doc, std::int64_t min, std::int64_t max,
                                   const Fallback<std::int64_t>& fallback) {
  const Range range{.min = static_cast<double>(min), .max = static_cast<double>(max)};
  add(key, doc, min == max ? Schema{{"const", min}} : number_schema("integer", range), fallback);
  return fallback.value.value_or(min);
}

bool Describer::do_flag(Key key, Doc doc, const Fallback<bool>& fallback) {
  add(key, doc, {{"type", "boolean"}}, fallback);
  return fallback.value.value_or(false);
}

std::string Describer::do_choice(Key key, Doc doc, Options options,
                                 const Fallback<std::string_view>& fallback) {
  add(key, doc, one_of_schema(options), fallback);
  return std::string(fallback.value.value_or(options.front()));
}

std::vector<std::string> Describer::do_choices(Key key, Doc doc, Options options) {
  Schema schema = list_schema(one_of_schema(options), {.min = 0, .max = options.size()});
  schema["uniqueItems"] = true;
  add(key, doc, std::move(schema), false);
  return {};
}

std::string Describer::do_text(Key key, Doc doc, std::size_t max_length, const char* fallback) {
  const Schema written = fallback ? Schema(fallback) : Schema();
  add(key, doc, {{"type", "string"}, {"maxLength", max_length}}, !fallback, fallback ? &written : nullptr);
  return fallback ? fallback : "";
}

Schema Describer::define(const char* name, const char* doc, Schema schema) {
  schema["description"] = doc;
  if (!definitions_.contains(name)) definitions_[name] = std::move(schema);
  return {{"$ref", std::string("#/$defs/") + name}};
}

Schema Describer::three(Kind kind, const Range& range) {
  Schema numbers = three_numbers("number", range);
  switch (kind) {
    case Kind::point: return define("point", "A point: x, y and z in metres.", numbers);
    case Kind::direction:
      numbers["not"] = {{"const", {0, 0, 0}}};
      return define("direction", "A direction of any length except 0.", numbers);
    case Kind::color:
      if (range.max != kMaxColor) return numbers;
      return define("color", "A colour: linear red, green and blue.", numbers);
    case Kind::coefficient:
      return {{"anyOf", Schema::array({number_schema("number", range), three(Kind::color, range)})}};
    case Kind::numbers: break;
  }
  return numbers;
}

Vec3d Describer::do_three(Key key, Doc doc, Kind kind, const Range& range, const Fallback<Vec3d>& fallback) {
  add(key, doc, three(kind, range), fallback);
  const double x = stand_in(range);
  return fallback.value.value_or(kind == Kind::direction ? Vec3d{0, 0, 1} : Vec3d{x, x, x});
}

std::vector<Vec3d> Describer::do_threes(Key key, Doc doc, Kind kind, Count count) {
  const Range coordinates{.min = -kMaxCoordinate, .max = kMaxCoordinate};
  add(key, doc, list_schema(three(kind, coordinates), count), count.min > 0,
      if_empty_allowed(count, kEmptyList));
  return std::vector<Vec3d>(count.min, kind == Kind::direction ? Vec3d{0, 0, 1} : Vec3d{});
}

std::vector<double> Describer::do_numbers(Key key, Doc doc, Count count, const Range& range) {
  add(key, doc, list_schema(number_schema("number", range), count), count.min > 0,
      if_empty_allowed(count, kEmptyList));
  return std::vector<double>(count.min, stand_in(range));
}

std::vector<std::array<double, 2>> Describer::do_pairs(Key key, Doc doc, Count count) {
  const Range coordinates{.min = -kMaxCoordinate, .max = kMaxCoordinate};
  add(key, doc, list_schema(list_schema(number_schema("number", coordinates), {.min = 2, .max = 2}), count),
      count.min > 0, if_empty_allowed(count, kEmptyList));
  return std::vector<std::array<double, 2>>(count.min);
}

std::vector<std::array<std::int64_t, 3>> Describer::do_triples(Key key, Doc doc, Count count, std::int64_t) {
  add(key, doc, list_schema(three_numbers("integer", {.min = 0}), count), count.min > 0,
      if_empty_allowed(count, kEmptyList));
  return std::vector<std::array<std::int64_t, 3>>(count.min);
}

void Describer::do_object(Key key, Doc doc, Missing missing, const Read& read) {
  add(key, doc, describe_object(read, definitions_), missing == Missing::problem,
      missing == Missing::empty ? &kEmptyObject : nullptr);
}

bool Describer::do_object_instead(Key key, std::string_view name, Doc doc, const Read& read) {
  const std::string as(name), text(doc);
  if (!definitions_.contains(as)) define(as.c_str(), text.c_str(), describe_object(read, definitions_));
  instead_[std::string(key)] = {{"$ref", "#/$defs/" + as}};
  return false;
}

void Describer::do_each(Key key, Doc doc, Count count, const Read& read) {
  add(key, doc, list_schema(describe_object(read, definitions_), count), count.min > 0,
      if_empty_allowed(count, kEmptyList));
}

void Describer::do_each_named(Key key, Doc doc, Count count, const ReadNamed& read) {
  Schema schema = {
      {"type", "object"},
      {"propertyNames", {{"minLength", 1}, {"maxLength", kMaxNameLength}}},
      {"additionalProperties", describe_object([&](Params& inside) { read("name", inside); }, definitions_)}};
  if (count.min > 0) schema["minProperties"] = count.min;
  if (count.max != Count{}.max) schema["maxProperties"] = count.max;
  add(key, doc, std::move(schema), count.min > 0, if_empty_allowed(count, kEmptyObject));
}

std::optional<std::size_t> Describer::do_pick(Key key, Doc doc, std::span<const Choice> choices) {
  const std::size_t taken = choices_.choose(choices.size());
  const Choice& choice = choices[taken];
  title_ = choice.type;
  summary_ = choice.summary;
  add(key, doc, {{"const", choice.type}}, true);
  return taken;
}

std::size_t Describer::do_form(KeySets key_sets) { return choices_.choose(key_sets.size()); }

std::size_t Describer::do_reference(Key key, Doc doc, const Names&) {
  add(key, doc, {{"type", "string"}, {"minLength", 1}, {"maxLength", kMaxNameLength}}, true);
  return 0;
}

std::optional<Document> Describer::do_any(Key key, Doc doc) {
  add(key, doc, Schema::object(), false);
  return std::nullopt;
}

std::string describe(std::string_view id, std::string_view title, std::string_view description,
                     const Params::Read& read) {
  Schema definitions = Schema::object();
  const Schema object = Describer::describe_object(read, definitions);
  Schema schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"$id", id},
                   {"title", title},
                   {"description", std::string(description) + kBeyond}};
  schema.update(object);
  if (!definitions.empty()) schema["$defs"] = std::move(definitions);
  return pretty(schema) + "\n";
}

}  // namespace orrery
