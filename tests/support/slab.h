#pragma once

// Radiative transfer in a plane slab, solved in double precision without random numbers.
namespace orrery::test {

struct SlabMedium {
  double thickness;  // in mean free paths
  double albedo;
  double anisotropy = 0;  // mean cosine g of Henyey and Greenstein
  double index = 1;       // index of refraction, relative to the surroundings
};

// Fractions of a beam that a slab sends back and lets through, both over all directions, with specular
// reflection and unscattered light.
struct SlabShares {
  double reflected, transmitted;
};

// Returns the shares for a beam along the normal, by doubling of thin layers in discrete ordinates (van de
// Hulst, "Multiple Light Scattering", 1980; boundaries as in Prahl, van Gemert, Welch, "Determining the
// Optical Properties of Turbid Media by Using the Adding-doubling Method", Applied Optics 32(4), 1993). The
// error is below 2e-6 for thickness <= 64 and |anisotropy| <= 0.8.
SlabShares slab_shares(const SlabMedium& medium);

}  // namespace orrery::test
