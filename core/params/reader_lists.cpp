#include <algorithm>
#include <cmath>

#include "core/base/shorten.h"
#include "core/params/json.h"
#include "core/params/reader.h"
#include "core/params/words.h"

// Member functions of Reader for arrays and objects. Valid elements allocate no text.

namespace orrery {

using nlohmann::json;

namespace {

const Range kCoordinates{.min = -kMaxCoordinate, .max = kMaxCoordinate};

std::string three_text(bool number_too, bool not_zero, const Range& range) {
  return std::string(number_too ? "a number or 3 numbers" : "3 numbers") + range_text(range) +
         (not_zero ? ", not all 0" : "");
}

}  // namespace

std::string Reader::location_text(const Location& location) const {
  std::string text = pointer(location.key);
  if (location.index) text += "/" + std::to_string(*location.index);
  if (location.name) text += pointer_step(*location.name);
  return text;
}

void Reader::read_three(const json& value, const Location& location, Kind kind, const Range& range,
                        Vec3d& three) {
  const bool number_too = kind == Kind::coefficient;
  const auto note_whole = [&] {
    note_value(location_text(location), three_text(number_too, kind == Kind::direction, range), value);
  };
  if (number_too && !value.is_array()) {
    const std::optional<double> number = number_in(value, range);
    if (!number) return note_whole();
    three = Vec3d{*number, *number, *number};
    return;
  }
  if (!value.is_array() || value.size() != 3) return note_whole();
  std::array<double, 3> numbers{};
  bool all_right = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = number_in(value[i], range);
    if (number) {
      numbers[i] = *number;
    } else {
      all_right = false;
      note_value(location_text(location) + "/" + std::to_string(i), "a number" + range_text(range), value[i]);
    }
  }
  if (!all_right) return;
  if (kind == Kind::direction && numbers == std::array{0.0, 0.0, 0.0}) return note_whole();
  three = Vec3d{numbers[0], numbers[1], numbers[2]};
}

Vec3d Reader::do_three(Key key, Doc, Kind kind, const Range& range, const Fallback<Vec3d>& fallback) {
  const auto allowed = [&] { return three_text(kind == Kind::coefficient, kind == Kind::direction, range); };
  const json* value = find(key, fallback.value ? Need::optional : Need::required, allowed);
  const double x = stand_in(range);
  Vec3d three = fallback.value.value_or(kind == Kind::direction ? Vec3d{0, 0, 1} : Vec3d{x, x, x});
  if (value) read_three(*value, {key}, kind, range, three);
  return three;
}

const json* Reader::find_list(Key key, Count count, std::string_view noun) {
  const auto allowed = [&] { return "a list of " + count_text(count) + " " + std::string(noun); };
  const json* list = find(key, count.min > 0 ? Need::required : Need::optional, allowed);
  if (!list) return nullptr;
  if (!list->is_array()) {
    note_value(pointer(key), allowed(), *list);
    return nullptr;
  }
  if (list->size() < count.min || list->size() > count.max) {
    note_size(pointer(key), allowed(), list->size());
    return nullptr;
  }
  return list;
}

std::vector<Vec3d> Reader::do_threes(Key key, Doc, Kind kind, Count count) {
  const json* list = find_list(key, count, kind == Kind::direction ? "directions" : "points");
  std::vector<Vec3d> all(list ? list->size() : count.min, kind == Kind::direction ? Vec3d{0, 0, 1} : Vec3d{});
  for (std::size_t i = 0; list && i < all.size(); ++i)
    read_three((*list)[i], {key, i}, kind, kCoordinates, all[i]);
  return all;
}

std::vector<double> Reader::do_numbers(Key key, Doc, Count count, const Range& range) {
  const json* list = find_list(key, count, "numbers");
  std::vector<double> all(list ? list->size() : count.min, stand_in(range));
  for (std::size_t i = 0; list && i < all.size(); ++i) {
    const std::optional<double> number = number_in((*list)[i], range);
    if (number)
      all[i] = *number;
    else
      note_value(location_text({key, i}), "a number" + range_text(range), (*list)[i]);
  }
  return all;
}

std::vector<std::array<double, 2>> Reader::do_pairs(Key key, Doc, Count count) {
  const json* list = find_list(key, count, "pairs of numbers");
  std::vector<std::array<double, 2>> all(list ? list->size() : count.min);
  for (std::size_t i = 0; list && i < all.size(); ++i) {
    const json& value = (*list)[i];
    const bool two = value.is_array() && value.size() == 2;
    const std::optional<double> u = two ? number_in(value[0], kCoordinates) : std::nullopt;
    const std::optional<double> v = two ? number_in(value[1], kCoordinates) : std::nullopt;
    if (u && v)
      all[i] = {*u, *v};
    else
      note_value(location_text({key, i}), "2 numbers" + range_text(kCoordinates), value);
  }
  return all;
}

void Reader::read_triple(const json& value, const Location& location, std::int64_t bound,
                         std::array<std::int64_t, 3>& triple) {
  const Range range{.min = 0, .max = static_cast<double>(bound - 1)};
  const auto allowed = [&](const char* noun) { return noun + range_text(range); };
  if (!value.is_array() || value.size() != 3)
    return note_value(location_text(location), allowed("3 integers"), value);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = number_in(value[i], range);
    if (number && *number == std::trunc(*number)) {
      triple[i] = static_cast<std::int64_t>(*number);
    } else {
      note_value(location_text(location) + "/" + std::to_string(i), allowed("an integer"), value[i]);
    }
  }
}

std::vector<std::array<std::int64_t, 3>> Reader::do_triples(Key key, Doc, Count count, std::int64_t bound) {
  const json* list = find_list(key, count, "triples of integers");
  std::vector<std::array<std::int64_t, 3>> all(list ? list->size() : count.min);
  for (std::size_t i = 0; list && i < all.size(); ++i) read_triple((*list)[i], {key, i}, bound, all[i]);
  return all;
}

std::vector<std::string> Reader::do_choices(Key key, Doc, Options options) {
  const json* list = find_list(key, {0, options.size()}, "different words");
  std::vector<std::string> words;
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const Location location{key, i};
    const std::string* word = read_choice((*list)[i], location, options);
    if (!word) continue;
    if (std::find(words.begin(), words.end(), *word) != words.end())
      note(location_text(location), "must not repeat an earlier word (got " + in_quotes(*word) + ")");
    words.push_back(*word);
  }
  return words;
}

void Reader::read_inside(const json& value, const Location& location, const Read& read) {
  if (!value.is_object()) return note_value(location_text(location), "an object", value);
  Reader inside(*this, location, value);
  read(inside);
  inside.finish();
}

void Reader::do_object(Key key, Doc, Missing missing, const Read& read) {
  static const json kEmpty = json::object();
  const Need need = missing == Missing::problem ? Need::required : Need::optional;
  const json* value = find(key, need, [] { return std::string("an object"); });
  if (value || missing == Missing::empty) read_inside(value ? *value : kEmpty, {key}, read);
}

bool Reader::do_object_instead(Key key, std::string_view, Doc, const Read& read) {
  const json* value = lookup(key);
  if (!value || !value->is_object()) return false;
  asked_.push_back(key);
  read_inside(*value, {key}, read);
  return true;
}

void Reader::do_each(Key key, Doc, Count count, const Read& read) {
  const json* list = find_list(key, count, "objects");
  for (std::size_t i = 0; list && i < list->size(); ++i) read_inside((*list)[i], {key, i}, read);
}

void Reader::do_each_named(Key key, Doc, Count count, const ReadNamed& read) {
  const auto allowed = [&] { return "an object with " + count_text(count) + " members"; };
  const json* map = find(key, count.min > 0 ? Need::required : Need::optional, allowed);
  if (!map) return;
  if (!map->is_object()) return note_value(pointer(key), allowed(), *map);
  if (map->size() < count.min || map->size() > count.max) {
    return note_size(pointer(key), allowed(), map->size());
  }
  for (const auto& [name, value] : map->get_ref<const json::object_t&>()) {
    const Location location{.key = key, .name = name};
    if (name.empty() || character_count(name) > kMaxNameLength) {
      note(location_text(location), "must be a name of 1 to " + std::to_string(kMaxNameLength) +
                                        " characters (got " + in_quotes(name) + ")");
      continue;
    }
    read_inside(value, location, [&, &name = name](Params& inside) { read(name, inside); });
  }
}

void read_document(const Document& document, const Params::Read& read) {
  if (!json_of(document).is_object()) {
    throw InputError(document.pointer(), "must be an object (got " + brief(json_of(document)) + ")");
  }
  ProblemList problems;
  Reader root(document, problems);
  read(root);
  root.finish();
  problems.throw_if_any();
}

}  // namespace orrery
