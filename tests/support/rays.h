#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/model/scene.h"
#include "tests/support/exhaustive.h"
#include "tests/support/scenes.h"

// Single rays against the shapes of a scene, in any precision. The kernels see whole batches.
namespace orrery::test {

template <class T>
struct Hit {
  T t = std::numeric_limits<T>::infinity();
  int primitive = kNoPrimitive;

  bool met() const { return primitive != kNoPrimitive; }
};

// The surface at a hit, as the shape tells it.
template <class T>
struct Spot {
  Vec3<T> position, geometric, normal;  // the normals stand on the ray's side
  T side, step;

  Vec3<T> outward() const { return geometric * side; }
  // A ray that leaves along `direction`, as a technique would send it.
  Ray<T> leaving(const Vec3<T>& direction) const {
    const T away = dot(direction, geometric) < T(0) ? -step : step;
    return {position + geometric * away, direction};
  }
};

template <class T>
using Rays = std::vector<Ray<T>>;

// All of them in an exhaustive run, else some 1,000 of those all over, and under a sanitizer in any case: it
// wants to see all of the code but not all numbers.
template <class T>
Rays<T> enough_of(const Rays<T>& rays) {
  if (!reduced()) return rays;
  constexpr std::size_t kEnough = 1'000;
  Rays<T> some;
  for (std::size_t i = 0; i < rays.size(); i += std::max<std::size_t>(1, rays.size() / kEnough))
    some.push_back(rays[i]);
  return some;
}

template <class T>
class Target {
 public:
  explicit Target(const Json& scene);
  // One object of a scene for each shape type, or several.
  static Target of_objects(std::string_view objects) { return Target(scene_of(objects)); }

  const Scene& scene() const { return *scene_; }
  int primitive_count() const { return scene_->primitive_count(); }
  ShapeTraits traits(int primitive) const;
  Boundsd bounds(int primitive) const;

  // The nearest hit of each ray, against all primitives or those of `only`.
  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays) const;
  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays, std::span<const int> only) const;
  Hit<T> closest(const Ray<T>& ray) const { return closest(std::span(&ray, 1)).front(); }
  // Whether anything stands on each ray nearer than `t_max`.
  std::vector<char> occluded(std::span<const Ray<T>> rays, T t_max) const;
  // Surfaces of the hits; those that met nothing are left alone.
  std::vector<Spot<T>> surfaces(std::span<const Ray<T>> rays, std::span<const Hit<T>> hits) const;
  Spot<T> surface(const Ray<T>& ray, const Hit<T>& hit) const {
    return surfaces(std::span(&ray, 1), std::span(&hit, 1)).front();
  }

 private:
  struct Part {
    ShapeKernelPtr<T> kernel;
    int first, last;
    ShapeTraits traits;
    const ShapeSet* set;
  };
  const Part& part_of(int primitive) const;

  std::shared_ptr<const Scene> scene_;
  std::vector<Part> parts_;
};

extern template class Target<float>;
extern template class Target<double>;
extern template class Target<long double>;

template <class To, class From>
Ray<To> convert_ray(const Ray<From>& ray) {
  if constexpr (std::is_same_v<To, From>)
    return ray;
  else
    return {Vec3<To>(ray.origin), Vec3<To>(ray.direction)};
}
template <class To, class From>
Rays<To> convert_rays(const Rays<From>& rays) {
  Rays<To> converted;
  for (const auto& ray : rays) converted.push_back(convert_ray<To>(ray));
  return converted;
}

}  // namespace orrery::test
