#include "core/params/params.h"

#include <cassert>

namespace orrery {

double Params::number(Key key, Doc doc, const Range& range, Fallback<double> fallback) {
  return do_number(key, doc, range, fallback);
}

double Params::positive(Key key, Doc doc, Fallback<double> fallback) {
  return do_number(key, doc, {.min = kMinLength, .max = kMaxLength}, fallback);
}

std::int64_t Params::integer(Key key, Doc doc, std::int64_t min, std::int64_t max,
                             Fallback<std::int64_t> fallback) {
  assert(-kMaxInteger <= static_cast<double>(min) && min <= max && static_cast<double>(max) <= kMaxInteger);
  return do_integer(key, doc, min, max, fallback);
}

bool Params::flag(Key key, Doc doc, Fallback<bool> fallback) { return do_flag(key, doc, fallback); }

std::string Params::choice(Key key, Doc doc, Options options, Fallback<std::string_view> fallback) {
  return do_choice(key, doc, options, fallback);
}

std::string Params::choice(Key key, Doc doc, std::initializer_list<std::string_view> options,
                           Fallback<std::string_view> fallback) {
  return do_choice(key, doc, Options(options.begin(), options.size()), fallback);
}

std::vector<std::string> Params::choices(Key key, Doc doc, Options options) {
  return do_choices(key, doc, options);
}

std::string Params::text(Key key, Doc doc, std::size_t max_length, const char* fallback) {
  return do_text(key, doc, max_length, fallback);
}

Vec3d Params::point(Key key, Doc doc, Fallback<Vec3d> fallback) {
  return do_three(key, doc, Kind::point, {.min = -kMaxCoordinate, .max = kMaxCoordinate}, fallback);
}

Vec3d Params::direction(Key key, Doc doc, Fallback<Vec3d> fallback) {
  const Range range{.min = -kMaxCoordinate, .max = kMaxCoordinate};
  return safe_normalize(do_three(key, doc, Kind::direction, range, fallback));
}

Vec3d Params::color(Key key, Doc doc, Fallback<Vec3d> fallback, double max) {
  return do_three(key, doc, Kind::color, {.min = 0, .max = max}, fallback);
}

Vec3d Params::coefficient(Key key, Doc doc, Fallback<Vec3d> fallback, double max) {
  return do_three(key, doc, Kind::coefficient, {.min = 0, .max = max}, fallback);
}

std::array<double, 3> Params::numbers3(Key key, Doc doc, const Range& range, Fallback<Vec3d> fallback) {
  const Vec3d v = do_three(key, doc, Kind::numbers, range, fallback);
  return {v.x, v.y, v.z};
}

std::vector<Vec3d> Params::points(Key key, Doc doc, Count count) {
  return do_threes(key, doc, Kind::point, count);
}

std::vector<Vec3d> Params::directions(Key key, Doc doc, Count count) {
  std::vector<Vec3d> all = do_threes(key, doc, Kind::direction, count);
  for (Vec3d& v : all) v = safe_normalize(v);
  return all;
}

std::vector<double> Params::numbers(Key key, Doc doc, Count count, const Range& range) {
  return do_numbers(key, doc, count, range);
}

std::vector<std::array<double, 2>> Params::pairs(Key key, Doc doc, Count count) {
  return do_pairs(key, doc, count);
}

std::vector<std::array<std::int64_t, 3>> Params::index_triples(Key key, Doc doc, Count count,
                                                               std::int64_t bound) {
  return do_triples(key, doc, count, bound);
}

void Params::object(Key key, Doc doc, const Read& read) { do_object(key, doc, Missing::problem, read); }
void Params::optional_object(Key key, Doc doc, const Read& read) {
  do_object(key, doc, Missing::empty, read);
}
void Params::object_if_given(Key key, Doc doc, const Read& read) {
  do_object(key, doc, Missing::nothing, read);
}
bool Params::object_instead(Key key, std::string_view name, Doc doc, const Read& read) {
  return do_object_instead(key, name, doc, read);
}

void Params::each(Key key, Doc doc, Count count, const Read& read) { do_each(key, doc, count, read); }
void Params::each_named(Key key, Doc doc, Count count, const ReadNamed& read) {
  do_each_named(key, doc, count, read);
}

std::optional<std::size_t> Params::pick(Key key, Doc doc, std::span<const Choice> choices) {
  return do_pick(key, doc, choices);
}

std::size_t Params::form(KeySets key_sets) { return do_form(key_sets); }
std::size_t Params::reference(Key key, Doc doc, const Names& names) { return do_reference(key, doc, names); }
std::optional<Document> Params::any(Key key, Doc doc) { return do_any(key, doc); }
bool Params::has(Key key) const { return do_has(key); }
void Params::fail(Key key, std::string detail) { do_fail(key, std::move(detail)); }
std::string Params::pointer(Key key) const { return do_pointer(key); }

}  // namespace orrery
