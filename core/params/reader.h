#pragma once

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/params/params.h"

// Params over a document: the reading mode. For core/params only.

namespace orrery {

// The problems of one document. Reading ends at once when there are as many as an InputError keeps.
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

// Where an object is in its parent: at a key, and if that holds a list or a map, at which element of it.
struct Location {
  std::string_view key;
  std::optional<std::size_t> index = {};
  std::optional<std::string_view> name = {};
};

// The number in `value`, if it is one and in range, with -0 turned into 0: canonical text cannot tell them
// apart.
std::optional<double> number_in(const nlohmann::json& value, const Range& range);

// One object of the document. Lives on the stack of the function that reads its parent, so the chain of
// parents spells the place of an error, and no place is built for values that are right.
class Reader final : public Params {
 public:
  // The root. REQUIRES: json_of(document) is an object.
  Reader(const Document& document, ProblemList& problems);
  Reader(Reader& parent, const Location& location, const nlohmann::json& object);

  // Every key must have been asked for. Not called when the type is unknown: so are its keys then.
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
  std::vector<std::array<double, 2>> do_pairs(Key, Doc, Count) override;
  std::vector<std::array<std::int64_t, 3>> do_triples(Key, Doc, Count, std::int64_t bound) override;
  void do_object(Key, Doc, Missing, const Read&) override;
  void do_each(Key, Doc, Count, const Read&) override;
  void do_each_named(Key, Doc, Count, const ReadNamed&) override;
  std::optional<std::size_t> do_pick(Key, Doc, std::span<const Choice>) override;
  std::size_t do_form(KeySets) override;
  std::size_t do_reference(Key, Doc, const Names&) override;
  std::optional<Document> do_any(Key, Doc) override;
  bool do_has(Key) const override;
  void do_fail(Key, std::string detail) override;
  std::string do_pointer(Key) const override;

  // What a key is for: a value that came, or none, and whether that is an error.
  enum class Need { required, optional };

  // The value of a key, which counts as asked for from now on. Null if it is missing; if it is needed, that
  // is noted, with `expected` (a function that returns the words) saying what would have been right.
  template <class Expected>
  const nlohmann::json* find(Key key, Need need, const Expected& expected) {
    asked_.push_back(key);
    const nlohmann::json* value = lookup(key);
    if (!value && need == Need::required) note_missing(key, expected());
    return value;
  }
  void note_missing(Key key, const std::string& expected);
  const nlohmann::json* lookup(Key key) const;
  // The list or map at `key` if it is of the type and its size is allowed.
  const nlohmann::json* find_list(Key key, Count count, std::string_view noun);

  // Checks one three of numbers; notes what is wrong with it and leaves `three` alone.
  void read_three(const nlohmann::json& value, const Location& location, Kind kind, const Range& range,
                  Vec3d& three);
  void read_triple(const nlohmann::json& value, const Location& location, std::int64_t bound,
                   std::array<std::int64_t, 3>& triple);
  // The word in `value` if it is one of the options; notes what is wrong with it and returns null if not.
  const std::string* read_choice(const nlohmann::json& value, const Location& location, Options options);
  // Runs `read` over the object `value`, and checks that it leaves no key unread.
  void read_inside(const nlohmann::json& value, const Location& location, const Read& read);

  void note(std::string pointer, std::string detail);
  void note_value(std::string pointer, const std::string& expected, const nlohmann::json& got,
                  const std::string& hint = "");
  std::string location_text(const Location& location) const;  // JSON Pointer

  Reader* parent_ = nullptr;
  Location location_;
  const Document& document_;
  ProblemList& problems_;
  const nlohmann::json* object_;
  std::vector<Key> asked_;
  std::vector<Key> excused_;  // keys whose absence was already explained
  bool broken_ = false;       // a value here or further in was wrong, and a stand-in was returned
  bool type_unknown_ = false;
};

}  // namespace orrery
