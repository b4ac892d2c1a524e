#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/model/material.h"
#include "tests/support/scenes.h"

// One material, asked directly about single directions.
namespace orrery::test {

// A unit direction at an angle of this cosine to the z axis, so many turns about it.
inline Vec3d tilted(double cosine, double turns = 0) {
  const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * std::numbers::pi * turns;
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

template <class T>
class Probe {
 public:
  // `material` as it stands in a scene.
  explicit Probe(const Json& material);
  explicit Probe(const char* material) : Probe(json(material)) {}

  // A ray that met the surface, and a light.
  struct Case {
    Vec3<T> direction{0, 0, -1};  // of the ray, unit
    Vec3<T> light{0, 0, 1};       // toward the light, unit
    Vec3<T> normal{0, 0, 1};      // for shading, on the ray's side
    Vec3<T> geometric{0, 0, 1};
    T side = 1;  // -1: the ray comes from the inside
    T t = 1;     // metres it came
  };
  struct Specular {
    Vec3<T> reflectance, transmittance, refracted, filter;
  };

  // What leaves toward the ray's origin of a light of intensity 1; 0 where the material leaves the light out.
  std::vector<Vec3<T>> reflected(std::span<const Case> cases) const;
  Vec3<T> reflected(const Case& one) const { return reflected(std::span(&one, 1)).front(); }
  // What the kernel says of these pairs of directions; f_cos is 0 where pdf is.
  struct Evaluated {
    Vec3<T> f_cos;
    T pdf;
  };
  std::vector<Evaluated> evaluated(std::span<const Case> cases, Lobes lobes = Lobes::all) const;
  Evaluated evaluated(const Case& one, Lobes lobes = Lobes::all) const {
    return evaluated(std::span(&one, 1), lobes).front();
  }
  // Directions drawn at one surface point, independent of each other.
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
  // What leaves under ambient light of 1.
  Vec3<T> ambient(const Case& one = {}, Lobes lobes = Lobes::all) const;

 private:
  std::shared_ptr<const Scene> scene_;
  MaterialKernelPtr<T> kernel_;
};

extern template class Probe<float>;
extern template class Probe<double>;

}  // namespace orrery::test
