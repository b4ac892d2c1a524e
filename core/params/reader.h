#pragma once

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/params/params.h"

// Reading mode of Params: reads values from a document. For core/params only.

namespace orrery {

// Problems of one document. add() throws InputError once the list has InputError::kMaxProblems entries.
class ProblemList {
 public:
  void add(std::string pointer, std::string detail) {
    problems_.push_back({std::move(pointer), std::move(detail)});
    if (problems_.size() == InputError::kMaxProblems) throw_if_any();
  }
  void throw_if_any() {
    if (!problems_.empty()) throw InputError(std::move(problems_));
  }

 private:
  std::vector<Problem> problems_;
};

// Place of a value in the enclosing object: a key, and an index or name if the value of the key is a list or
// map.
struct Location {
  std::string_view key;
  std::optional<std::size_t> index = {};
  std::optional<std::string_view> name = {};
};

// Returns the number in `value`, or nullopt if `value` is not a number or is out of range. Returns 0 for -0,
// since canonical text does not distinguish them.
std::optional<double> number_in(const nlohmann::json& value, const Range& range);

// Reader of one object. Lives on the stack of the function that reads the enclosing object. The pointer of an
// error is built from the chain of enclosing readers, so valid values allocate no text.
class Reader final : public Params {
 public:
  // Reads the root. REQUIRES: json_of(document) is an object.
  Reader(const Document& document, ProblemList& problems);
  Reader(Reader& parent, const Location& location, const nlohmann::json& object);

  // Reports every key that was not read. Does nothing if pick() returned nullopt, since the valid keys are
  // then unknown.
  void finish();

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
  bool do_has(Key) const override;
  void do_fail(Key, std::string detail) override;
  std::string do_pointer(Key) const override;

  // Whether a missing key is an error.
  enum class Need { required, optional };

  // Returns the value of `key`, or null if it is missing. Marks the key as read. A missing required key is
  // reported with the text of `allowed()`.
  template <class Allowed>
  const nlohmann::json* find(Key key, Need need, const Allowed& allowed) {
    asked_.push_back(key);
    const nlohmann::json* value = lookup(key);
    if (!value && need == Need::required) note_missing(key, allowed());
    return value;
  }
  void note_missing(Key key, const std::string& allowed);
  // Returns the name of `key` in this object: its former name if the object contains only that name, else
  // `key`.
  Key written_key(Key key) const;
  const nlohmann::json* member(Key name) const;  // by exactly this name; null if missing
  const nlohmann::json* lookup(Key key) const;   // by present or former name; null if missing
  // Returns the list at `key`, or null if it is missing. Reports an error and returns null if a required list
  // is missing, if the value is not a list, or if the list has the wrong size.
  const nlohmann::json* find_list(Key key, Count count, std::string_view noun);

  // Reads a triple of numbers. Reports an error and leaves `three` unchanged if the value is invalid.
  void read_three(const nlohmann::json& value, const Location& location, Kind kind, const Range& range,
                  Vec3d& three);
  void read_triple(const nlohmann::json& value, const Location& location, std::int64_t bound,
                   std::array<std::int64_t, 3>& triple);
  // Returns the string in `value` if it is one of the options. Otherwise reports an error and returns null.
  const std::string* read_choice(const nlohmann::json& value, const Location& location, Options options);
  // Runs `read` over the object `value` and reports its unread keys.
  void read_inside(const nlohmann::json& value, const Location& location, const Read& read);

  void note(std::string pointer, std::string detail);
  // Reports "must be `allowed` (got `got`)". With a suggestion, reports "must be `allowed` (got `got`; did
  // you mean `suggestion`?)".
  void note_value(std::string pointer, const std::string& allowed, const nlohmann::json& got,
                  const std::optional<std::string>& suggestion = {});
  // Reports that a list or map has the wrong size.
  void note_size(std::string pointer, const std::string& allowed, std::size_t entries);
  std::string location_text(const Location& location) const;  // JSON Pointer

  Reader* parent_ = nullptr;
  Location location_;
  const Document& document_;
  ProblemList& problems_;
  const nlohmann::json* object_;
  std::vector<Key> asked_;     // keys that the read function declared
  std::vector<Key> excused_;   // keys that are not reported as missing, because form() reported an error
  bool broken_ = false;        // a value in this object or in one inside it was invalid
  bool type_unknown_ = false;  // pick() returned nullopt
};

}  // namespace orrery
