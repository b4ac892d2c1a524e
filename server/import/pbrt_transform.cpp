#include <array>
#include <cmath>

#include "core/params/params.h"
#include "server/import/pbrt_state.h"

namespace orrery {
namespace {

struct TransformDirective {
  std::string_view name;
  std::size_t numbers;
  Affined (*map)(const std::vector<double>& n, const ImportPlace& place);
};

// 16 numbers, a column after the other.
Affined matrix_of(const std::vector<double>& n, const ImportPlace& place) {
  if (n[3] != 0 || n[7] != 0 || n[11] != 0 || n[15] == 0)
    refuse_at(
        place,
        "transformation must be affine: entries 4, 8 and 12 must be 0 and entry 16 must not be 0 (got " +
            number_text(n[3]) + ", " + number_text(n[7]) + ", " + number_text(n[11]) + ", " +
            number_text(n[15]) + ")");
  const auto column = [&](std::size_t i) { return Vec3d(n[i], n[i + 1], n[i + 2]) / n[15]; };
  return {column(0), column(4), column(8), column(12)};
}

// Map of LookAt: from the scene to camera space.
Affined look_at(const std::vector<double>& n, const ImportPlace& place) {
  const Affined map = looking_at({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]});
  if (scaled_determinant(map) == 0)
    refuse_at(place, "LookAt must have two different points and a direction up that is not along the view");
  return inverse(map);
}

Affined rotate(const std::vector<double>& n, const ImportPlace& place) {
  const Vec3d axis = safe_normalize(Vec3d(n[1], n[2], n[3]));
  if (axis == Vec3d(0, 0, 0)) refuse_at(place, "axis of Rotate must not be 0 (got 0, 0, 0)");
  return rotation(axis, std::fmod(n[0], 360));
}

constexpr std::array<TransformDirective, 6> kDirectives{
    {{"LookAt", 9, look_at},
     {"Translate", 3,
      [](const std::vector<double>& n, const ImportPlace&) {
        return translation({n[0], n[1], n[2]});
      }},
     {"Scale", 3,
      [](const std::vector<double>& n, const ImportPlace&) {
        return scaling({n[0], n[1], n[2]});
      }},
     {"Rotate", 4, rotate},
     {"Transform", 16, matrix_of},
     {"ConcatTransform", 16, matrix_of}}};

const TransformDirective* find_transform(std::string_view name) {
  for (const TransformDirective& one : kDirectives)
    if (one.name == name) return &one;
  return nullptr;
}

}  // namespace

bool is_pbrt_transform(std::string_view directive) { return find_transform(directive) != nullptr; }

PbrtTransform pbrt_transform(std::string_view directive, PbrtLexer& lexer) {
  const TransformDirective& found = *find_transform(directive);
  const ImportPlace place = lexer.place();
  const std::vector<double> n = read_numbers(lexer, found.numbers, directive);
  const bool looks = directive == "LookAt";
  return {found.map(n, place), looks ? length(Vec3d(n[3] - n[0], n[4] - n[1], n[5] - n[2])) : 0};
}

}  // namespace orrery
