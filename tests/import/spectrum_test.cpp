#include "server/import/spectrum.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

// Compares colours of spectra with chromaticities that the CIE states.
namespace orrery::test {
namespace {

struct Chromaticity {
  double x, y;
};
Chromaticity chromaticity_of(const Vec3d& rgb) {  // IEC 61966-2-1
  const double x = 0.4124564 * rgb.x + 0.3575761 * rgb.y + 0.1804375 * rgb.z;
  const double y = 0.2126729 * rgb.x + 0.7151522 * rgb.y + 0.0721750 * rgb.z;
  const double z = 0.0193339 * rgb.x + 0.1191920 * rgb.y + 0.9503041 * rgb.z;
  return {x / (x + y + z), y / (x + y + z)};
}

// Illuminant A is a black body of 2856 K by definition (CIE 15). 6500 K: Wyszecki and Stiles, table 1(3.11).
TEST(Spectrum, BlackbodyHasKnownChromaticity) {
  const auto a = chromaticity_of(emitted_rgb_of_blackbody(2856));
  EXPECT_NEAR(a.x, 0.4476, 0.003);
  EXPECT_NEAR(a.y, 0.4074, 0.003);
  const auto day = chromaticity_of(emitted_rgb_of_blackbody(6500));
  EXPECT_NEAR(day.x, 0.3135, 0.003);
  EXPECT_NEAR(day.y, 0.3237, 0.003);
}

// By Stefan's law, radiance grows with the fourth power of the temperature; within visible light it grows
// faster. Wien's law: the same T lambda at four times the temperature has 4^5 times the radiance.
TEST(Spectrum, BlackbodyGrowsWithTemperature) {
  EXPECT_GT(luminance_of(emitted_rgb_of_blackbody(6000)), 16 * luminance_of(emitted_rgb_of_blackbody(3000)));
}

TEST(Spectrum, EqualEnergySpectrumHasEqualChromaticities) {
  const auto e = chromaticity_of(emitted_rgb({{{300, 1}, {900, 1}}}));
  EXPECT_NEAR(e.x, 1 / 3.0, 0.003);
  EXPECT_NEAR(e.y, 1 / 3.0, 0.003);
  EXPECT_NEAR(luminance_of(emitted_rgb({{{300, 1}, {900, 1}}})), 1, 1e-3);
}

TEST(Spectrum, ConstantReflectanceIsGrey) {
  const Vec3d grey = reflected_rgb({{{300, 0.5}, {900, 0.5}}});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(grey[i], 0.5, 1e-3);
  EXPECT_GT(reflected_rgb({{{580, 0}, {620, 1}, {700, 1}}}).x, 0.2);
  EXPECT_LT(reflected_rgb({{{580, 0}, {620, 1}, {700, 1}}}).z, 0.02);
}

TEST(Spectrum, NamedIlluminantsHaveTheirChromaticityAndLuminance1) {
  EXPECT_EQ(illuminant_rgb("stdillum-D65"), Vec3d(1));
  const auto f11 = chromaticity_of(*illuminant_rgb("stdillum-F11"));
  EXPECT_NEAR(f11.x, 0.38052, 1e-3);
  EXPECT_NEAR(luminance_of(*illuminant_rgb("stdillum-A")), 1, 1e-12);
  EXPECT_EQ(illuminant_rgb("stdillum-G"), std::nullopt);
}

TEST(Spectrum, ReadsFilesWithComments) {
  const SpectrumTable table = read_spectrum("# nm value\n400 1\n\n500 3\n");
  EXPECT_EQ(table.at(450), 2);
  EXPECT_EQ(table.at(400), 1);
  EXPECT_EQ(table.at(399), 0);
  EXPECT_EQ(table.at(501), 0);
  EXPECT_THROW(read_spectrum("500 1\n400 1\n"), InputError);
  EXPECT_THROW(read_spectrum("# none"), InputError);
  EXPECT_THROW(read_spectrum("500 nan"), InputError);
}

}  // namespace
}  // namespace orrery::test
