#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math/vec3.h"

namespace orrery {

// Spectrum by its values at ascending wavelengths in nm, linear between them and 0 outside.
struct SpectrumTable {
  std::vector<std::pair<double, double>> points;  // wavelength and value; at least one

  double at(double wavelength) const;
};

// Reads a spectrum file: a wavelength and a value per line; # starts a comment. Throws InputError (pointer
// "") with the line.
SpectrumTable read_spectrum(std::string_view text);

// Returns linear sRGB of CIE XYZ (IEC 61966-2-1). Negative components, of colours outside of the gamut,
// become 0.
Vec3d rgb_of_xyz(const Vec3d& xyz);
// Returns the linear colour of luminance 1 with this CIE 1931 chromaticity.
Vec3d rgb_of_chromaticity(double x, double y);

// Return the linear colour of an emitter. A spectrum of 1 W / (m^2 sr nm) at all wavelengths has luminance 1.
Vec3d emitted_rgb(const SpectrumTable& spectrum);
// Black body (Planck's law), in W / (m^2 sr nm). REQUIRES: kelvin > 0.
Vec3d emitted_rgb_of_blackbody(double kelvin);
// Returns the colour of a surface: each of X, Y and Z relative to a white surface, which is white.
Vec3d reflected_rgb(const SpectrumTable& spectrum);
// Returns the values at 650, 550 and 450 nm, the wavelengths of the indices of metals.
Vec3d indices_of(const SpectrumTable& spectrum);

// Returns the colour scaled to a luminance of 1 (BT.709), or black for black.
Vec3d with_unit_luminance(const Vec3d& rgb);
double luminance_of(const Vec3d& rgb);

// Returns the colour of luminance 1 of a CIE illuminant by its name in pbrt, such as "stdillum-D65".
std::optional<Vec3d> illuminant_rgb(std::string_view name);

// Index of refraction at 589 nm of a glass by its name in pbrt, or of a material by its name in Mitsuba.
std::optional<double> index_of(std::string_view name);

// Metal by its name in pbrt and Mitsuba, such as "Cu".
struct NamedMetal {
  std::string_view name;         // chemical symbol, or name of the alloy
  std::string_view orrery_name;  // name of scenes, or empty
  Vec3d n, k;                    // if there is no name of scenes
};
const NamedMetal* metal_named(std::string_view symbol);

}  // namespace orrery
