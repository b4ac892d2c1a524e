#include "core/params/reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/shorten.h"
#include "core/params/former_names.h"
#include "core/params/json.h"
#include "core/params/suggest.h"
#include "core/params/words.h"

namespace orrery {
namespace {

using nlohmann::json;

// Returns the value if it is an integer (3.0 is one), else nullopt. Integers are not converted through
// double, which would round values above 2^53.
std::optional<std::int64_t> integer_of(const json& value) {
  if (value.is_number_float()) {
    const double x = value.get<double>();
    return std::abs(x) <= kMaxInteger && x == std::trunc(x) ? std::optional(static_cast<std::int64_t>(x))
                                                            : std::nullopt;
  }
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max())
    return std::nullopt;
  return value.get<std::int64_t>();
}

}  // namespace

std::optional<double> number_in(const json& value, const Range& range) {
  if (!value.is_number()) return std::nullopt;
  const double x = value.get<double>() + 0.0;
  return range.contains(x) ? std::optional(x) : std::nullopt;
}

Reader::Reader(const Document& document, ProblemList& problems)
    : document_(document), problems_(problems), object_(&json_of(document)) {}

Reader::Reader(Reader& parent, const Location& location, const json& object)
    : parent_(&parent),
      location_(location),
      document_(parent.document_),
      problems_(parent.problems_),
      object_(&object) {
  asked_.reserve(8);
}

void Reader::finish() {
  if (type_unknown_) return;
  const auto was_asked = [&](Key key) {
    return std::find(asked_.begin(), asked_.end(), key) != asked_.end() ||
           std::any_of(asked_.begin(), asked_.end(), [&](Key asked) { return written_key(asked) == key; });
  };
  for (const auto& [key, value] : object_->get_ref<const json::object_t&>()) {
    if (was_asked(key)) continue;
    std::vector<Key> free;  // declared keys that are absent, to suggest from
    std::copy_if(asked_.begin(), asked_.end(), std::back_inserter(free), [&](Key k) { return !lookup(k); });
    problems_.add(pointer(), "unknown key " + in_quotes(key) + did_you_mean_key(key, free));
  }
}

Reader::Key Reader::written_key(Key key) const {
  const Key former = former_name(key);
  return !former.empty() && !member(key) && member(former) ? former : key;
}

const json* Reader::member(Key name) const {
  const auto& members = object_->get_ref<const json::object_t&>();
  const auto found = members.find(name);
  return found == members.end() ? nullptr : &found->second;
}

const json* Reader::lookup(Key key) const {
  if (const json* value = member(key)) return value;
  const Key former = former_name(key);
  return former.empty() ? nullptr : member(former);
}

void Reader::note_missing(Key key, const std::string& allowed) {
  if (std::find(excused_.begin(), excused_.end(), key) != excused_.end()) return;
  note(pointer(), "missing key " + in_quotes(key) + " (must be " + allowed + ")");
}

void Reader::note(std::string pointer, std::string detail) {
  for (Reader* r = this; r; r = r->parent_) r->broken_ = true;
  problems_.add(std::move(pointer), std::move(detail));
}

void Reader::note_value(std::string pointer, const std::string& allowed, const json& got,
                        const std::optional<std::string>& suggestion) {
  const std::string hint = suggestion ? "; did you mean " + in_quotes(*suggestion) + "?" : "";
  note(std::move(pointer), "must be " + allowed + " (got " + brief(got) + hint + ")");
}

void Reader::note_size(std::string pointer, const std::string& allowed, std::size_t entries) {
  note(std::move(pointer),
       "must be " + allowed + " (got " + std::to_string(entries) + (entries == 1 ? " entry)" : " entries)"));
}

double Reader::do_number(Key key, Doc, const Range& range, const Fallback<double>& fallback) {
  const auto allowed = [&] { return "a number" + range_text(range); };
  const json* value = find(key, fallback.value ? Need::optional : Need::required, allowed);
  const std::optional<double> number = value ? number_in(*value, range) : std::nullopt;
  if (value && !number) note_value(pointer(key), allowed(), *value);
  return number.value_or(fallback.value.value_or(stand_in(range)));
}

std::int64_t Reader::do_integer(Key key, Doc, std::int64_t min, std::int64_t max,
                                const Fallback<std::int64_t>& fallback) {
  const auto allowed = [&] {
    return min == max ? std::to_string(min)
                      : "an integer from " + std::to_string(min) + " to " + std::to_string(max);
  };
  const json* value = find(key, fallback.value ? Need::optional : Need::required, allowed);
  if (!value) return fallback.value.value_or(min);
  const std::optional<std::int64_t> number = integer_of(*value);
  if (number && *number >= min && *number <= max) return *number;
  note_value(pointer(key), allowed(), *value);
  return fallback.value.value_or(min);
}

bool Reader::do_flag(Key key, Doc, const Fallback<bool>& fallback) {
  const auto allowed = [] { return std::string("true or false"); };
  const json* value = find(key, fallback.value ? Need::optional : Need::required, allowed);
  if (value && value->is_boolean()) return value->get<bool>();
  if (value) note_value(pointer(key), allowed(), *value);
  return fallback.value.value_or(false);
}

const std::string* Reader::read_choice(const json& value, const Location& location, Options options) {
  const std::string* word = value.get_ptr<const std::string*>();
  if (word && std::find(options.begin(), options.end(), *word) != options.end()) return word;
  note_value(location_text(location), choice_text(options), value,
             word ? nearest(*word, options) : std::nullopt);
  return nullptr;
}

std::string Reader::do_choice(Key key, Doc, Options options, const Fallback<std::string_view>& fallback) {
  const auto allowed = [&] { return choice_text(options); };
  const json* value = find(key, fallback.value ? Need::optional : Need::required, allowed);
  const std::string* word = value ? read_choice(*value, {key}, options) : nullptr;
  return word ? *word : std::string(fallback.value.value_or(options.front()));
}

std::string Reader::do_text(Key key, Doc, std::size_t max_length, const char* fallback) {
  const auto allowed = [&] { return "a string of at most " + std::to_string(max_length) + " characters"; };
  const json* value = find(key, fallback ? Need::optional : Need::required, allowed);
  if (!value) return fallback ? fallback : "";
  const std::string* text = value->get_ptr<const std::string*>();
  if (text && character_count(*text) <= max_length) return *text;
  note_value(pointer(key), allowed(), *value);
  return fallback ? fallback : "";
}

std::size_t Reader::do_reference(Key key, Doc, const Names& names) {
  const auto allowed = [&] { return "the name of a " + names.kind(); };
  const json* value = find(key, Need::required, allowed);
  if (!value) return 0;
  const std::string* name = value->get_ptr<const std::string*>();
  if (!name) {
    note_value(pointer(key), allowed(), *value);
    return 0;
  }
  const std::optional<std::size_t> index = names.find(*name);
  if (!index) {
    std::vector<Key> known;
    for (const auto& entry : names.index_of()) {
      if (known.size() == kMaxCandidates) break;
      known.push_back(entry.first);
    }
    note(pointer(key), "unknown " + names.kind() + " " + in_quotes(*name) + did_you_mean(*name, known));
  }
  return index.value_or(0);
}

std::optional<std::size_t> Reader::do_pick(Key key, Doc, std::span<const Choice> choices) {
  std::vector<Key> types;
  const auto allowed = [&] {
    types.clear();
    for (const Choice& choice : choices) types.push_back(choice.type);
    return choice_text(types);
  };
  const json* value = find(key, Need::required, allowed);
  const std::string* word = value ? value->get_ptr<const std::string*>() : nullptr;
  if (word) {
    const auto chosen =
        std::find_if(choices.begin(), choices.end(), [&](const Choice& c) { return c.type == *word; });
    if (chosen != choices.end()) return static_cast<std::size_t>(chosen - choices.begin());
  }
  if (value) {
    const std::string words = allowed();
    note_value(pointer(key), words, *value, word ? nearest(*word, types) : std::nullopt);
  }
  type_unknown_ = true;
  return std::nullopt;
}

std::size_t Reader::do_form(KeySets key_sets) {
  const auto present = [&](std::initializer_list<Key> keys) {
    return std::count_if(keys.begin(), keys.end(), [&](Key k) { return lookup(k) != nullptr; });
  };
  std::size_t best = 0, begun = 0;
  std::ptrdiff_t most = 0;
  std::vector<std::string> sets;
  for (const auto& keys : key_sets) {
    if (present(keys) > 0) ++begun;
    if (present(keys) > most || (most == 0 && keys.size() == 0)) best = sets.size();
    most = std::max(most, present(keys));
    sets.push_back(one_of(std::span(keys.begin(), keys.size()), " and "));
  }
  const bool empty_allowed = std::find(sets.begin(), sets.end(), "") != sets.end();
  if (begun == 1 || (begun == 0 && empty_allowed)) return best;

  std::string allowed, got;
  for (const std::string& set : sets) {
    if (!set.empty()) allowed += (allowed.empty() ? "either " : ", or ") + set;
  }
  for (const auto& keys : key_sets) {
    for (const Key key : keys) {
      if (lookup(key)) got += (got.empty() ? "" : ", ") + in_quotes(key);
      asked_.push_back(key);
      excused_.push_back(key);
    }
  }
  note(pointer(), "must have " + allowed + " (got " + (got.empty() ? "none of them" : got) + ")");
  return best;
}

std::optional<Document> Reader::do_any(Key key, Doc) {
  const json* value = find(key, Need::optional, [] { return std::string(); });
  if (!value) return std::nullopt;
  return DocumentAccess::part(document_, *value, pointer(key));
}

bool Reader::do_has(Key key) const { return lookup(key) != nullptr; }

void Reader::do_fail(Key key, std::string detail) {
  if (!broken_) problems_.add(pointer(key), std::move(detail));
}

std::string Reader::do_pointer(Key key) const {
  std::string text = parent_ ? parent_->location_text(location_) : document_.pointer();
  if (!key.empty()) text += pointer_step(written_key(key));
  return text;
}

}  // namespace orrery
