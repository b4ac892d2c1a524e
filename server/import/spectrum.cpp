#include "server/import/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/task_scope.h"
#include "core/meshes/text.h"
#include "core/model/texture.h"

namespace orrery {
namespace {

constexpr double kFirstWavelength = 360, kLastWavelength = 830;  // nm, in steps of 1
constexpr Vec3d kWhite{0.95047, 1, 1.08883};                     // XYZ of D65

// CIE 1931 colour matching functions: multi-lobe fit of Wyman, Sloan and Shirley, "Simple Analytic
// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, equation 4.
double lobe(double wavelength, double centre, double below, double above) {
  const double t = (wavelength - centre) / (wavelength < centre ? below : above);
  return std::exp(-t * t / 2);
}
Vec3d matching(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

// Integral of value(nm) times the matching functions.
template <class Value>
Vec3d integral(const Value& value) {
  Vec3d sum(0.0);
  for (double nm = kFirstWavelength; nm <= kLastWavelength; ++nm) sum = sum + matching(nm) * value(nm);
  return sum;
}
Vec3d integral_of_one() {
  return integral([](double) { return 1.0; });
}

struct NamedIlluminant {
  std::string_view name;
  double x, y;
};
// Chromaticities of CIE 15:2004, tables 2 and T.8; ACES white: SMPTE ST 2065-1.
constexpr std::array<NamedIlluminant, 16> kIlluminants{{{"stdillum-A", 0.44757, 0.40745},
                                                        {"stdillum-D50", 0.34567, 0.35850},
                                                        {"stdillum-D65", 0.31271, 0.32902},
                                                        {"stdillum-F1", 0.31310, 0.33727},
                                                        {"stdillum-F2", 0.37208, 0.37529},
                                                        {"stdillum-F3", 0.40910, 0.39430},
                                                        {"stdillum-F4", 0.44018, 0.40329},
                                                        {"stdillum-F5", 0.31379, 0.34531},
                                                        {"stdillum-F6", 0.37790, 0.38835},
                                                        {"stdillum-F7", 0.31292, 0.32933},
                                                        {"stdillum-F8", 0.34588, 0.35875},
                                                        {"stdillum-F9", 0.37417, 0.37281},
                                                        {"stdillum-F10", 0.34609, 0.35986},
                                                        {"stdillum-F11", 0.38052, 0.37713},
                                                        {"stdillum-F12", 0.43695, 0.40441},
                                                        {"illum-acesD60", 0.32168, 0.33767}}};

struct NamedIndex {
  std::string_view name;
  double n;
};
// Glasses: n_d of the catalogue of Schott, under the names of pbrt. Materials: documentation of Mitsuba 3,
// plugin "dielectric".
constexpr std::array<NamedIndex, 33> kIndices{{{"glass-BK7", 1.5168},
                                               {"glass-BAF10", 1.6700},
                                               {"glass-FK51A", 1.4866},
                                               {"glass-LASF9", 1.8503},
                                               {"glass-F5", 1.6727},
                                               {"glass-SF5", 1.6727},
                                               {"glass-F10", 1.7283},
                                               {"glass-SF10", 1.7283},
                                               {"glass-F11", 1.7847},
                                               {"glass-SF11", 1.7847},
                                               {"vacuum", 1},
                                               {"helium", 1.00004},
                                               {"hydrogen", 1.00013},
                                               {"air", 1.00028},
                                               {"carbon dioxide", 1.00045},
                                               {"water", 1.333},
                                               {"acetone", 1.36},
                                               {"ethanol", 1.361},
                                               {"carbon tetrachloride", 1.461},
                                               {"glycerol", 1.4729},
                                               {"benzene", 1.501},
                                               {"silicone oil", 1.52045},
                                               {"bromine", 1.661},
                                               {"water ice", 1.31},
                                               {"fused quartz", 1.458},
                                               {"pyrex", 1.47},
                                               {"acrylic glass", 1.49},
                                               {"polypropylene", 1.49},
                                               {"bk7", 1.5046},
                                               {"diamond", 2.419},
                                               {"sodium chloride", 1.544},
                                               {"amber", 1.55},
                                               {"pet", 1.575}}};

// Brass: Querry 1985, sampled at 650, 550 and 450 nm.
constexpr std::array<NamedMetal, 6> kMetals{{{"Au", "gold", {}, {}},
                                             {"Ag", "silver", {}, {}},
                                             {"Cu", "copper", {}, {}},
                                             {"Al", "aluminium", {}, {}},
                                             {"Fe", "iron", {}, {}},
                                             {"CuZn", "", {0.444, 0.527, 1.094}, {3.695, 2.765, 1.829}}}};

template <class List>
const typename List::value_type* find_named(const List& list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  return found == list.end() ? nullptr : &*found;
}

}  // namespace

double SpectrumTable::at(double wavelength) const {
  const auto after = std::lower_bound(points.begin(), points.end(), wavelength,
                                      [](const auto& point, double nm) { return point.first < nm; });
  if (after == points.end()) return 0;
  if (after->first == wavelength) return after->second;
  if (after == points.begin()) return 0;
  const auto& [from, low] = *(after - 1);
  const double share = (wavelength - from) / (after->first - from);
  return low + share * (after->second - low);
}

SpectrumTable read_spectrum(std::string_view text) {
  SpectrumTable table;
  TextReader reader(text);
  do {
    const std::string_view word = reader.word_of_line();
    if (word.empty() || word.starts_with('#')) continue;
    const double nm = reader.parse_number(word, "wavelength");
    const double value = reader.parse_number(reader.word_of_line(), "value");
    if (!table.points.empty() && nm <= table.points.back().first)
      reader.fail("wavelengths must be in ascending order (got " + std::string(word) + ")");
    table.points.emplace_back(nm, value);
  } while (reader.next_line());
  if (table.points.empty()) reader.fail("spectrum must have at least one wavelength (got none)");
  return table;
}

Vec3d rgb_of_xyz(const Vec3d& c) {
  return largest(Vec3d(0.0), {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
                              -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
                              0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z});
}

Vec3d rgb_of_chromaticity(double x, double y) {
  return with_unit_luminance(rgb_of_xyz({x / y, 1, (1 - x - y) / y}));
}

Vec3d emitted_rgb(const SpectrumTable& spectrum) {
  return rgb_of_xyz(integral([&](double nm) { return spectrum.at(nm); }) / integral_of_one().y);
}

Vec3d emitted_rgb_of_blackbody(double kelvin) {
  constexpr double kC1 = 1.191042972e-16;  // 2 h c^2 in W m^2 / sr (CODATA 2018)
  constexpr double kC2 = 1.438776877e-2;   // h c / k in m K
  const auto radiance = [&](double nm) {
    const double metres = nm * 1e-9;
    return 1e-9 * kC1 / (std::pow(metres, 5) * std::expm1(kC2 / (metres * kelvin)));
  };
  return rgb_of_xyz(integral(radiance) / integral_of_one().y);
}

Vec3d reflected_rgb(const SpectrumTable& spectrum) {
  const Vec3d got = integral([&](double nm) { return spectrum.at(nm); }), white = integral_of_one();
  return rgb_of_xyz({kWhite.x * got.x / white.x, kWhite.y * got.y / white.y, kWhite.z * got.z / white.z});
}

Vec3d indices_of(const SpectrumTable& spectrum) {
  return {spectrum.at(650), spectrum.at(550), spectrum.at(450)};
}

double luminance_of(const Vec3d& rgb) { return dot(rgb, channel_weights(TextureChannel::luminance)); }

Vec3d with_unit_luminance(const Vec3d& rgb) {
  const double luminance = luminance_of(rgb);
  return luminance > 0 ? rgb / luminance : Vec3d(0.0);
}

std::optional<Vec3d> illuminant_rgb(std::string_view name) {
  if (name == "stdillum-D65") return Vec3d(1);
  const NamedIlluminant* const found = find_named(kIlluminants, name);
  if (found == nullptr) return std::nullopt;
  return rgb_of_chromaticity(found->x, found->y);
}

std::optional<double> index_of(std::string_view name) {
  const NamedIndex* const found = find_named(kIndices, name);
  if (found == nullptr) return std::nullopt;
  return found->n;
}

const NamedMetal* metal_named(std::string_view symbol) { return find_named(kMetals, symbol); }

}  // namespace orrery
