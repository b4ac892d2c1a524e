#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/model/scene.h"
#include "tests/support/exhaustive.h"
#include "tests/support/scenes.h"

// Intersects single rays with the shapes of a scene, in any precision. Kernels receive whole batches.
namespace orrery::test {

template <class T>
struct Hit {
  T t = std::numeric_limits<T>::infinity();
  int primitive = kNoPrimitive;

  bool met() const { return primitive != kNoPrimitive; }
};

// Surface at a hit.
template <class T>
struct SurfaceSample {
  Vec3<T> position, geometric, normal;  // the normals are on the ray's side
  T side, step;

  Vec3<T> outward() const { return geometric * side; }
  // Returns a ray that leaves along `direction`, with the offset that a technique would use.
  Ray<T> leaving(const Vec3<T>& direction) const {
    const T away = dot(direction, geometric) < T(0) ? -step : step;
    return {position + geometric * away, direction};
  }
};

template <class T>
using Rays = std::vector<Ray<T>>;

// Returns all rays in an exhaustive run without sanitizers, otherwise about 1,000 evenly spaced rays.
template <class T>
Rays<T> subsample_rays(const Rays<T>& rays) {
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
  // Returns a target of one object or a list of objects in JSON.
  static Target of_objects(std::string_view objects) { return Target(scene_of(objects)); }

  const Scene& scene() const { return *scene_; }
  int primitive_count() const { return scene_->primitive_count(); }
  ShapeTraits traits(int primitive) const;
  Boundsd bounds(int primitive) const;

  // Returns the closest hit of each ray with all primitives, or only with the primitives in `only`.
  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays) const;
  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays, std::span<const int> only) const;
  Hit<T> closest(const Ray<T>& ray) const { return closest(std::span(&ray, 1)).front(); }
  // Returns whether each ray is occluded before `t_max`.
  std::vector<char> occluded(std::span<const Ray<T>> rays, T t_max) const;
  // Returns the surfaces of the hits. Elements of misses are unspecified.
  std::vector<SurfaceSample<T>> surfaces(std::span<const Ray<T>> rays, std::span<const Hit<T>> hits) const;
  SurfaceSample<T> surface(const Ray<T>& ray, const Hit<T>& hit) const {
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
