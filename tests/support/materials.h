#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/model/material.h"
#include "tests/support/scenes.h"

// Evaluation of one material for single directions.
namespace orrery::test {

// Returns a unit direction whose angle to the z axis has cosine `cosine`, rotated by `turns` turns about this
// axis.
inline Vec3d tilted(double cosine, double turns = 0) {
  const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * std::numbers::pi * turns;
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

template <class T>
class Probe {
 public:
  // `material`: JSON as in a scene.
  explicit Probe(const Json& material);
  explicit Probe(const char* material) : Probe(json(material)) {}

  // Ray that hits the surface, and a light.
  struct Case {
    Vec3<T> direction{0, 0, -1};  // unit direction of the ray
    Vec3<T> light{0, 0, 1};       // unit direction toward the light
    Vec3<T> normal{0, 0, 1};      // shading normal, on the ray's side
    Vec3<T> geometric{0, 0, 1};
    T side = 1;  // -1: the ray comes from the inside
    T t = 1;     // length of the ray, metres
  };
  struct Specular {
    Vec3<T> reflectance, transmittance, refracted, filter;
  };

  // Returns the radiance reflected toward the ray's origin for a light of intensity 1, or 0 if the material
  // ignores the light.
  std::vector<Vec3<T>> reflected(std::span<const Case> cases) const;
  Vec3<T> reflected(const Case& one) const { return reflected(std::span(&one, 1)).front(); }
  // Result of the kernel for a pair of directions. pi_bsdf_cos, pi times BSDF times cosine, is 0 if pdf is 0.
  struct Evaluation {
    Vec3<T> pi_bsdf_cos;
    T pdf;
  };
  std::vector<Evaluation> evaluated(std::span<const Case> cases, Lobes lobes = Lobes::all) const;
  Evaluation evaluated(const Case& one, Lobes lobes = Lobes::all) const {
    return evaluated(std::span(&one, 1), lobes).front();
  }
  // Independent sample of a direction at one surface point.
  struct Sampled {
    Vec3<T> direction, weight;
    T pdf;
  };
  std::vector<Sampled> sampled(const Case& one, int count, std::uint64_t seed = 1,
                               Lobes lobes = Lobes::all) const;
  std::vector<Specular> specular(std::span<const Case> cases) const;
  Specular specular(const Case& one) const { return specular(std::span(&one, 1)).front(); }
  MaterialTraits traits() const;
  ReflectionLimits limits() const;
  // Returns the reflected radiance for ambient light of radiance 1.
  Vec3<T> ambient(const Case& one = {}, Lobes lobes = Lobes::all) const;

 private:
  std::shared_ptr<const Scene> scene_;
  MaterialKernelPtr<T> kernel_;
};

extern template class Probe<float>;
extern template class Probe<double>;

// Returns a case whose viewer is at an angle to the normal with this cosine.
inline Probe<double>::Case seen_at(double cosine, double side = 1) {
  Probe<double>::Case one;
  one.direction = -tilted(cosine);
  one.side = side;
  return one;
}

}  // namespace orrery::test
