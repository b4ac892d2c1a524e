#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

// Tests the sampling contract of every scattering material.
namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

struct Material {
  const char *name, *text;
  double side = 1;  // side of the viewer: -1 is inside
  double ior = 0;   // index of transmitting materials, inside over outside, or 0
};
const Material kMaterials[] = {
    {"Lambert", "{'type': 'lambert', 'reflectance': [0.9, 0.5, 0.1]}"},
    {"OrenNayar", "{'type': 'oren-nayar', 'reflectance': [0.9, 0.5, 0.1], 'roughness': 0.7}"},
    {"PolishedMetal",
     "{'type': 'metal', 'n': [0.143, 0.375, 1.442], 'k': [3.983, 2.386, 1.603], 'roughness': 0.3}"},
    {"BrushedMetal",
     "{'type': 'metal', 'n': [0.143, 0.375, 1.442], 'k': [3.983, 2.386, 1.603], 'roughness': 0.6}"},
    {"RoughestMetal", "{'type': 'metal', 'n': [0, 0, 0], 'k': [1, 1, 1], 'roughness': 1}"},
    {"FrostedGlass", "{'type': 'glass', 'ior': 1.5, 'roughness': 0.5}", 1, 1.5},
    {"FrostedGlassFromInside", "{'type': 'glass', 'ior': 1.5, 'roughness': 0.5}", -1, 1.5},
    {"RougherGlass", "{'type': 'glass', 'ior': 1.8, 'roughness': 0.6}", 1, 1.8},
    {"RougherGlassFromInside", "{'type': 'glass', 'ior': 1.8, 'roughness': 0.6}", -1, 1.8},
    {"RoughWax",
     "{'type': 'subsurface', 'ior': 1.5, 'roughness': 0.5, 'albedo': 0.9, 'mean_free_path': 1e12}", 1, 1.5},
    {"RoughBubble", "{'type': 'glass', 'ior': 0.75, 'roughness': 0.6}", 1, 0.75},
    {"Plastic", "{'type': 'plastic', 'reflectance': [0.9, 0.5, 0.1], 'roughness': 0.4}"},
    {"BlackPlastic", "{'type': 'plastic', 'reflectance': 0, 'roughness': 0.7}"},
    {"MetallicRoughness",
     "{'type': 'metallic-roughness', 'base_color': [0.9, 0.5, 0.1], 'metallic': 0.5, 'roughness': 0.6}"},
    {"StrictMetallicRoughness",
     "{'type': 'metallic-roughness', 'base_color': 1, 'roughness': 0.5, 'strict': true}"},
    {"Coated",
     "{'type': 'coated', 'base_color': [0.9, 0.5, 0.1], 'metallic': 0.5, 'roughness': 0.6, 'coat': 0.8, "
     "'coat_roughness': 0.4, 'sheen_color': [0.2, 0.5, 0.7], 'sheen_roughness': 0.6}"},
    {"CookTorrance",
     "{'type': 'cook-torrance', 'n': [1.5, 1.5, 1.5], 'slope': 0.4, 'diffuse': [0.4, 0.2, 0.1], "
     "'specular': 0.6}"},
    {"Translucent",
     "{'type': 'translucent', 'reflectance': [0.4, 0.3, 0.2], 'transmittance': [0.1, 0.5, 0.3]}", 1, 1},
};

constexpr int kViewers = 5;
Vec3d viewer(int number) {
  const double cosine[kViewers] = {1, 0.85, 0.5, 0.2, 0.05};
  return tilted(cosine[number], (0.7 + 1.3 * number) / (2 * std::numbers::pi));
}
Case seen_from(const Vec3d& viewer, double side = 1) {
  Case c;
  c.direction = -viewer;
  c.side = side;
  return c;
}

// Cells over both hemispheres: rings of equal width in r, where the cosine is 1 - r^2, and sectors of
// azimuth. Each cell has a grid of kPointsAcross x kPointsAround points for integration.
constexpr int kRings = 48, kSectors = 64, kPointsAcross = 8, kPointsAround = 20;
struct Cells {
  std::vector<double> mass = std::vector<double>(2 * kRings * kSectors);

  static std::size_t of(const Vec3d& direction) {
    const double r = std::sqrt(std::max(0.0, 1 - std::abs(direction.z)));
    const int ring = std::min(kRings - 1, static_cast<int>(r * kRings)) + (direction.z < 0 ? kRings : 0);
    const double turns = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi) + 0.5;
    return static_cast<std::size_t>(ring * kSectors +
                                    std::min(kSectors - 1, static_cast<int>(turns * kSectors)));
  }
  double sum() const { return std::accumulate(mass.begin(), mass.end(), 0.0); }
};

// Returns the integral of the material's density over each cell. The grid does not resolve the sharp edge
// that the density of very rough glass has at upright facets.
Cells cells_of(const Probe<double>& material, const Case& point, Lobes lobes = Lobes::all) {
  constexpr int kRows = kRings * kPointsAcross, kColumns = kSectors * kPointsAround;
  std::vector<Case> cases;
  std::vector<double> angle_share;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kColumns; ++j) {
      const double r = (i + 0.5) / (kRows), turns = (j + 0.5) / (kColumns)-0.5;
      const double z = 1 - r * r, sine = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * turns;
      for (const double side : {1.0, -1.0}) {
        cases.push_back(point);
        cases.back().light = Vec3d(sine * std::cos(angle), sine * std::sin(angle), side * z);
        angle_share.push_back(4 * std::numbers::pi * r / (kRows * kColumns));
      }
    }
  const auto found = material.evaluated(cases, lobes);
  Cells cells;
  for (std::size_t i = 0; i < cases.size(); ++i)
    cells.mass[Cells::of(cases[i].light)] += found[i].pdf * angle_share[i];
  return cells;
}

// Returns by how many standard deviations chi-square exceeds its mean (Wilson and Hilferty). Absorbed samples
// and cells with an expected count below 5 are merged into one cell.
double chi_square_deviations(const Cells& expected, const std::vector<Probe<double>::Sampled>& drawn) {
  std::vector<double> count(expected.mass.size());
  double lost = 0;
  for (const auto& one : drawn) (one.pdf > 0 ? count[Cells::of(one.direction)] : lost) += 1;
  const auto total = static_cast<double>(drawn.size());
  double chi2 = 0, rest_expected = total * (1 - expected.sum()), rest = lost;
  int degrees = 0;
  const auto add = [&](double found, double mean) {
    chi2 += (found - mean) * (found - mean) / mean;
    ++degrees;
  };
  for (std::size_t i = 0; i < count.size(); ++i) {
    const double mean = total * expected.mass[i];
    if (mean >= 5) {
      add(count[i], mean);
    } else {
      rest_expected += mean;
      rest += count[i];
    }
  }
  if (rest_expected >= 5) add(rest, rest_expected);
  const double k = degrees - 1, spread = 2 / (9 * k);
  return (std::cbrt(chi2 / k) - (1 - spread)) / std::sqrt(spread);
}

class Scattering : public testing::TestWithParam<Material> {};

// With correct samples, fewer than one in a hundred runs of these 80 tests exceeds 3.68 standard deviations
// (Sidak). The integral of the density equals the fraction of samples that are not absorbed.
TEST_P(Scattering, SamplesInProportionToDensity) {
  covers("light-24 light-25");
  const Probe<double> material(GetParam().text);
  for (int v = 0; v < kViewers; ++v) {
    const Case point = seen_from(viewer(v), GetParam().side);
    const auto drawn = material.sampled(point, 500'000);
    const Cells cells = cells_of(material, point);
    const double z = chi_square_deviations(cells, drawn);
    EXPECT_LT(z, 3.68) << "viewer " << v;
    EXPECT_GT(z, -5) << "viewer " << v;
    const auto leave = std::count_if(drawn.begin(), drawn.end(), [](const auto& d) { return d.pdf > 0; });
    EXPECT_NEAR(cells.sum(), static_cast<double>(leave) / 500'000, 2e-3) << "viewer " << v;
  }
}

// For radiance, f / n^2 is reciprocal, where n is the refractive index on the side of the light.
TEST_P(Scattering, IsReciprocal) {
  covers("light-26");
  const Probe<double> material(GetParam().text);
  const double side = GetParam().side, ior = GetParam().ior;
  const double near = side > 0 ? 1 : ior, far = side > 0 ? ior : 1;
  Random random(1);
  std::vector<Case> there, back;
  for (int i = 0; i < 100'000; ++i) {
    const Vec3d a = random.direction_above(Vec3d(0, 0, 1)), above = random.direction_above(Vec3d(0, 0, 1));
    const bool through = ior > 0 && random.below(2);
    const Vec3d b(above.x, above.y, through ? -above.z : above.z);
    there.push_back(seen_from(a, side));
    there.back().light = b;
    back.push_back(seen_from(b, through ? -side : side));
    back.back().light = a;
    if (through) back.back().normal = back.back().geometric = Vec3d(0, 0, -1);
    there.back().t = back.back().t = 0;  // nothing is absorbed on the way to the surface
  }
  const auto forth = material.evaluated(there), reverse = material.evaluated(back);
  double worst = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const double change = there[i].light.z < 0 ? far * far / (near * near) : 1;
    const double f = forth[i].pi_bsdf_cos.x / std::abs(there[i].light.z);
    const double r = reverse[i].pi_bsdf_cos.x / back[i].light.z * change;
    if (f > 0) worst = std::max(worst, std::abs(f - r) / std::max(f, r));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST_P(Scattering, WeightsSamplesByEvaluation) {
  const Probe<double> material(GetParam().text);
  for (int v = 0; v < kViewers; ++v) {
    std::vector<Case> cases;
    const auto drawn = material.sampled(seen_from(viewer(v), GetParam().side), 10'000);
    for (const auto& d : drawn) {
      cases.push_back(seen_from(viewer(v), GetParam().side));
      cases.back().light = d.direction;
    }
    const auto told = material.evaluated(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (drawn[i].pdf == 0) {
        ASSERT_EQ(drawn[i].weight, Vec3d());
        continue;
      }
      ASSERT_EQ(drawn[i].pdf, told[i].pdf);
      ASSERT_NEAR(length(drawn[i].direction), 1, 1e-14);
      const double scale = 1 / (std::numbers::pi * told[i].pdf);
      ASSERT_NEAR(length(drawn[i].weight - told[i].pi_bsdf_cos * scale), 0,
                  1e-13 * (1 + length(drawn[i].weight)));
    }
  }
}

// Float rounding changes directions by 1e-7, and the narrowest lobe is 0.09 wide. The tolerances allow for
// this.
TEST_P(Scattering, AgreesInFloatAndDouble) {
  const Probe<double> exact(GetParam().text);
  const Probe<float> single(GetParam().text);
  Random random(3);
  std::vector<Case> doubles;
  std::vector<Probe<float>::Case> floats;
  for (int i = 0; i < 20'000; ++i) {
    Case c = seen_from(random.direction_above(Vec3d(0, 0, 1)), GetParam().side);
    c.light = random.below(2) ? random.direction_above(c.normal)
                              : Vec3d(c.direction.x, c.direction.y, -c.direction.z);
    if (GetParam().ior > 0 && random.below(2)) c.light.z = -c.light.z;
    Probe<float>::Case f;
    f.side = static_cast<float>(c.side);
    f.direction = Vec3f(c.direction);
    f.light = Vec3f(c.light);
    doubles.push_back(c);
    floats.push_back(f);
  }
  const auto a = exact.evaluated(doubles);
  const auto b = single.evaluated(floats);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(b[i].pi_bsdf_cos.x), a[i].pi_bsdf_cos.x,
                2e-4 * (a[i].pi_bsdf_cos.x + 0.01));
    ASSERT_NEAR(static_cast<double>(b[i].pdf), a[i].pdf, 2e-4 * (a[i].pdf + 0.01));
  }
}

// In some cases the interpolated normal faces away from the viewer, or the light is behind the surface.
template <class T>
void million_points(const Material& tested) {
  const Probe<T> material(tested.text);
  const bool transmits = tested.ior > 0;
  Random random(4);
  std::vector<typename Probe<T>::Case> cases(1'000'000);
  for (auto& c : cases) {
    const Vec3d normal = random.direction();
    c.geometric = safe_normalize(Vec3<T>(normal));
    c.direction = -safe_normalize(Vec3<T>(random.below(4) ? random.direction_above(normal) : normal));
    c.normal = random.below(2) ? c.geometric : safe_normalize(Vec3<T>(random.direction()));
    c.side = static_cast<T>(tested.side);
    c.light = random.below(4) ? safe_normalize(Vec3<T>(random.direction()))
                              : (random.below(2) ? -c.direction : c.direction);
  }
  int wrong = 0;
  const auto found = material.evaluated(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [pi_bsdf_cos, pdf] = found[i];
    wrong += !(std::isfinite(pdf) && pdf >= 0 && std::isfinite(pi_bsdf_cos.x) && pi_bsdf_cos.x >= 0);
    wrong += pdf > 0 && !transmits && !(dot(cases[i].light, cases[i].geometric) > 0);
  }
  for (int i = 0; i < 2'000; ++i)
    for (const auto& drawn : material.sampled(cases[static_cast<std::size_t>(i)], 64)) {
      wrong += !(std::isfinite(drawn.pdf) && std::isfinite(drawn.weight.x) && drawn.weight.x >= 0);
      wrong += !(std::abs(length(drawn.direction) - 1) < 8 * std::numeric_limits<T>::epsilon());
      wrong += drawn.pdf > 0 && !transmits &&
               !(dot(drawn.direction, cases[static_cast<std::size_t>(i)].geometric) > 0);
    }
  EXPECT_EQ(wrong, 0);
}
TEST_P(Scattering, StaysFiniteForMillionPoints) {
  covers("A32");
  million_points<float>(GetParam());
  million_points<double>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Materials, Scattering, testing::ValuesIn(kMaterials),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Paints and other materials that are not reciprocal or create energy.
const Material kPaints[] = {
    {"Paint", "{'type': 'rough', 'kd': [0.5, 0.2, 0], 'ks': 0.5, 'shininess': 30}"},
    {"PhongPaint",
     "{'type': 'rough', 'kd': 0.5, 'ks': [0.1, 0.5, 0.2], 'shininess': 12, 'shading': 'phong'}"},
    {"FaintHighlight", "{'type': 'rough', 'kd': 0.5, 'ks': 0.5, 'shininess': 0.5}"},
    {"HighlightAlone", "{'type': 'rough', 'kd': 0, 'ks': 0.5, 'shininess': 100}"},
    {"InterpolatedPane", "{'type': 'transparent', 'kd': [0.5, 0.2, 0], 'ks': 0.5, 'kt': 0.4}"},
    {"FilteredPane",
     "{'type': 'transparent', 'kd': 0.5, 'blend': 'filtered', 'kt': 1.5, 'transmission_color': [1, 0.5, 0], "
     "'ks': 0.3}"},
    {"ClearHall", "{'type': 'hall', 'kd': [0.3, 0.2, 0], 'kt_diffuse': 0.3, 'shininess': 9}", 1, 1.5},
    {"ClearHallFromInside", "{'type': 'hall', 'kd': 0.3, 'kt_diffuse': 0.3, 'shininess': 9}", -1, 1.5},
    {"OpaqueHall", "{'type': 'hall', 'kd': 0.3, 'ks': 0.5, 'kt': 0, 'ior': 3, 'shininess': 30}"},
};
std::vector<Material> materials_and_paints() {
  std::vector<Material> all(std::begin(kMaterials), std::end(kMaterials));
  all.insert(all.end(), std::begin(kPaints), std::end(kPaints));
  return all;
}

// Tests diffuse and non-diffuse lobes separately.
class MaterialLobes : public testing::TestWithParam<Material> {
 protected:
  // Returns the lobe classes of the material.
  std::vector<Lobes> parts() const {
    std::vector<Lobes> found;
    for (const Lobes lobes : {Lobes::diffuse, Lobes::non_diffuse})
      if (material_.traits().has(lobes)) found.push_back(lobes);
    return found;
  }
  const Probe<double> material_{GetParam().text};
};

TEST_P(MaterialLobes, SumsToWholeMaterial) {
  Random random(5);
  std::vector<Case> cases;
  for (int i = 0; i < 10'000; ++i) {
    Case c = seen_from(random.direction_above(Vec3d(0, 0, 1)), GetParam().side);
    c.light = random.direction_above(c.normal);
    if (GetParam().ior > 0 && random.below(2)) c.light.z = -c.light.z;
    cases.push_back(c);
  }
  const auto whole = material_.evaluated(cases);
  std::vector<Vec3d> sum(cases.size());
  Vec3d ambient;
  for (const Lobes lobes : parts()) {
    const auto part = material_.evaluated(cases, lobes);
    for (std::size_t i = 0; i < cases.size(); ++i) sum[i] = sum[i] + part[i].pi_bsdf_cos;
    ambient = ambient + material_.ambient({}, lobes);
  }
  for (std::size_t i = 0; i < cases.size(); ++i)
    ASSERT_NEAR(length(sum[i] - whole[i].pi_bsdf_cos), 0, 1e-12 * (1 + length(sum[i])));
  EXPECT_NEAR(length(ambient - material_.ambient()), 0, 1e-14);
}

// Repeats the test of Scattering for each lobe class of a material, and for all lobes of a paint.
TEST_P(MaterialLobes, SamplesInProportionToDensity) {
  covers("light-24");
  constexpr int kDraws = 200'000;
  std::vector<Lobes> asked = parts();
  const auto is_paint = [](const Material& paint) { return paint.name == std::string_view(GetParam().name); };
  if (std::any_of(std::begin(kPaints), std::end(kPaints), is_paint)) asked.push_back(Lobes::all);
  for (const Lobes lobes : asked) {
    const Case point = seen_from(viewer(2), GetParam().side);
    const auto drawn = material_.sampled(point, kDraws, 2, lobes);
    const double z = chi_square_deviations(cells_of(material_, point, lobes), drawn);
    EXPECT_LT(z, 3.68) << static_cast<int>(lobes);
    EXPECT_GT(z, -5) << static_cast<int>(lobes);
  }
}

TEST_P(MaterialLobes, WeightsSamplesByEvaluation) {
  for (const Lobes lobes : parts()) {
    const Case point = seen_from(viewer(2), GetParam().side);
    std::vector<Case> cases;
    const auto drawn = material_.sampled(point, 10'000, 3, lobes);
    for (const auto& d : drawn) {
      cases.push_back(point);
      cases.back().light = d.direction;
    }
    const auto told = material_.evaluated(cases, lobes);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (drawn[i].pdf == 0) continue;
      ASSERT_NEAR(drawn[i].pdf, told[i].pdf, 1e-13 * told[i].pdf);
      const double scale = 1 / (std::numbers::pi * told[i].pdf);
      ASSERT_NEAR(length(drawn[i].weight - told[i].pi_bsdf_cos * scale), 0,
                  1e-12 * (1 + length(drawn[i].weight)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, MaterialLobes, testing::ValuesIn(materials_and_paints()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Path reuse requires surfaces that look the same from every direction.
TEST(MaterialTraits, MarksViewDependentMaterialsAsGlossy) {
  std::vector<Material> all(std::begin(kMaterials), std::end(kMaterials));
  all.push_back({"Matt", "{'type': 'rough', 'kd': 0.5}"});
  all.push_back({"Shiny", "{'type': 'rough', 'kd': 0.5, 'ks': 0.5, 'shininess': 4}"});
  for (const Material& material : all) {
    const Probe<double> probe(material.text);
    bool same = true;
    for (int a = 0; a < kViewers; ++a) {
      Case first = seen_from(viewer(0)), other = seen_from(viewer(a));
      first.light = other.light = safe_normalize(Vec3d(0.3, -0.2, 0.6));
      same = same && length(probe.evaluated(first).pi_bsdf_cos - probe.evaluated(other).pi_bsdf_cos) < 1e-12;
    }
    EXPECT_EQ(probe.traits().glossy, !same) << material.name;
  }
}

}  // namespace
}  // namespace orrery::test
