#pragma once

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/params/params.h"

// Describing mode of Params: writes a JSON Schema instead of reading a document. For core/params only.

namespace orrery {

using Schema = nlohmann::ordered_json;

// Enumerates the combinations of alternatives that the pick() and form() calls of a read function can select,
// depth first. The read function is called once, and again while advance() returns true. Each call selects
// one combination, and each combination is selected once.
class Choices {
 public:
  std::size_t choose(std::size_t alternatives) {
    if (next_ == steps_.size()) steps_.push_back({0, alternatives});
    return steps_[next_++].first;
  }
  bool advance() {
    next_ = 0;
    for (; !steps_.empty(); steps_.pop_back()) {
      if (++steps_.back().first < steps_.back().second) return true;
    }
    return false;
  }

 private:
  // For each call of choose(), in order: selected alternative, number of alternatives.
  std::vector<std::pair<std::size_t, std::size_t>> steps_;
  std::size_t next_ = 0;
};

// Schema of one combination of choices, i.e. of one set of keys that an object may have. Every value returned
// to the read function is a default or a placeholder.
class Describer final : public Params {
 public:
  // Adds the schemas of points, directions and colours to `definitions` ($defs) when they are first used.
  Describer(Choices& choices, Schema& definitions) : choices_(choices), definitions_(definitions) {}

  // Returns the schema of all combinations of choices: the schema of one object, or a "oneOf" with one schema
  // for each combination.
  static Schema describe_object(const Read& read, Schema& definitions);

 private:
  double do_number(Key, Doc, const Range&, const Fallback<double>&) override;
  std::int64_t do_integer(Key, Doc, std::int64_t min, std::int64_t max,
                          const Fallback<std::int64_t>&) override;
  bool do_flag(Key, Doc, const Fallback<bool>&) override;
  std::string do_choice(Key, Doc, Options, const Fallback<std::string_view>&) override;
  std::vector<std::string> do_choices(Key, Doc, Options) override;
  std::string do_text(Key, Doc, std::size_t max_length, const char* fallback) override;
  Vec3d do_three(Key, Doc, Kind, const Range&, const Fallback<Vec3d>&) override;
  std::vector<Vec3d> do_threes(Key, Doc, Kind, Count) override;
  std::vector<double> do_numbers(Key, Doc, Count, const Range&) override;
  std::vector<std::array<double, 2>> do_pairs(Key, Doc, Count) override;
  std::vector<std::array<std::int64_t, 3>> do_triples(Key, Doc, Count, std::int64_t bound) override;
  void do_object(Key, Doc, Missing, const Read&) override;
  bool do_object_instead(Key, std::string_view name, Doc, const Read&) override;
  void do_each(Key, Doc, Count, const Read&) override;
  void do_each_named(Key, Doc, Count, const ReadNamed&) override;
  std::optional<std::size_t> do_pick(Key, Doc, std::span<const Choice>) override;
  std::size_t do_form(KeySets) override;
  std::size_t do_reference(Key, Doc, const Names&) override;
  std::optional<Document> do_any(Key, Doc) override;
  bool do_has(Key) const override { return false; }
  void do_fail(Key, std::string) override {}
  std::string do_pointer(Key) const override { return ""; }

  // Adds a property. A null `fallback` writes no default into the schema.
  void add(Key key, Doc doc, Schema schema, bool required, const Schema* fallback = nullptr);
  template <class T>
  void add(Key key, Doc doc, Schema schema, const Fallback<T>& fallback);
  Schema three(Kind kind, const Range& range);
  Schema define(const char* name, const char* doc, Schema schema);
  Schema finish();

  Choices& choices_;
  Schema& definitions_;
  std::string title_, summary_;  // from the picked Choice
  Schema properties_ = Schema::object();
  Schema instead_ = Schema::object();  // schemas of object_instead(), by key
  Schema required_ = Schema::array();
};

// Formats a schema as JSON, indented by 2 spaces per level. A value that fits within 110 columns is written
// on one line.
std::string pretty(const Schema& schema);

}  // namespace orrery
