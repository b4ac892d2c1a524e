#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Shadow, reflected and refracted rays that leave a surface must not hit their starting point.
namespace orrery::test {
namespace {

template <class T>
std::vector<Placement> places_of_sizes() {
  std::vector<Placement> places;
  for (const double offset : {0.0, 1.0, 1e3, 1e6})
    for (const double size : {1e-5, 1.0, 1e6})
      if (std::is_same_v<T, double> || offset <= 1e3 * size)
        places.push_back({size, Vec3d(offset, offset, offset)});
  return places;
}

struct Tally {
  int rays = 0, self_hits = 0, leaks = 0;
};

template <class T>
class Leaver {
 public:
  Leaver(const Json& object, const Placement& placement, int count)
      : scene_(scene_with(placement.of(object))), shape_(scene_), exact_(scene_) {
    for (const auto& ray : rays_at<T>(object, placement, count, 5))
      if (shape_.closest(ray).met()) rays_.push_back(ray);
    hits_ = shape_.closest(rays_);
    spots_ = shape_.surfaces(rays_, hits_);
  }

  // Sends two rays from each hit, one outward and one into the shape. Half of the rays are nearly tangential.
  void leave(Random& random, Tally& tally) const {
    Rays<T> up, down;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const Vec3d normal = safe_normalize(Vec3d(spots_[i].geometric));
      Vec3d direction = random.direction_above(normal);
      const Vec3d along = cross(cross(normal, direction), normal);  // perpendicular to within an ulp
      if (i % 2) direction = safe_normalize(safe_normalize(along) + normal * random.magnitude(kMinTilt, 0.1));
      up.push_back(spots_[i].leaving(Vec3<T>(direction)));
      down.push_back(spots_[i].leaving(Vec3<T>(direction - normal * (2 * dot(direction, normal)))));
    }
    const auto above = shape_.closest(up), below = shape_.closest(down);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const int primitive = hits_[i].primitive;
      const bool closed = shape_.traits(primitive).closed;
      ++tally.rays;
      if (closed && spots_[i].side < 0) continue;  // from inside, a ray may hit another part of the shape
      tally.self_hits +=
          above[i].primitive == primitive && !meets_other_part(up[i], above[i].t, spots_[i].step);
      if (closed)
        tally.leaks += !below[i].met() && runs_inside(down[i], spots_[i].step);
      else
        tally.self_hits +=
            below[i].primitive == primitive && !meets_other_part(down[i], below[i].t, spots_[i].step);
    }
  }

 private:
  static constexpr double kMinTilt = 256 * static_cast<double>(std::numeric_limits<T>::epsilon());

  // Returns false if an inward ray at an edge exits through the adjacent face within `step`.
  bool runs_inside(const Ray<T>& ray, T step) const {
    const auto way = exact_.closest(convert_ray<long double>(ray));
    return way.met() && way.t > static_cast<long double>(step);
  }

  // Returns true if the shape is not convex and a ray that leaves it hits another part of it at about `t`.
  // The other part may be missed by half of `step`, because hits at an edge are within rounding errors of it.
  bool meets_other_part(const Ray<T>& ray, T t, T step) const {
    if (shape_.traits(0).convex) return false;
    const auto exact = convert_ray<long double>(ray);
    const auto shift = static_cast<long double>(step) / 2;
    Rays<long double> copies = {exact};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const long double sign : {1.0L, -1.0L}) {
        copies.push_back(exact);
        copies.back().origin[axis] += sign * shift;
      }
    const auto hits = exact_.closest(copies);
    return std::any_of(hits.begin(), hits.end(),
                       [&](const auto& hit) { return hit.t <= 2 * static_cast<long double>(t); });
  }

  Json scene_;
  Target<T> shape_;
  Target<long double> exact_;
  Rays<T> rays_;
  std::vector<Hit<T>> hits_;
  std::vector<SurfaceSample<T>> spots_;
};

class SecondaryRays : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  void check(int total) {
    const auto places = places_of_sizes<T>();
    const auto& samples = shape_samples(GetParam());
    // Shapes of many primitives, which are all tested, use fewer rays.
    if (!exhaustive() && Target<T>(scene_with(samples[0])).primitive_count() > 16) total /= 20;
    Tally tally;
    Random random(31);
    for (const Json& object : samples)
      for (const Placement& placement : places) {
        const Tally before = tally;
        const Leaver<T> leaver(object, placement, 1000);
        const int target = tally.rays + total / static_cast<int>(samples.size() * places.size());
        while (tally.rays < target) leaver.leave(random, tally);
        EXPECT_EQ(tally.self_hits - before.self_hits, 0)
            << object << " of size " << placement.size << " at " << placement.offset.x;
        EXPECT_EQ(tally.leaks - before.leaks, 0)
            << object << " of size " << placement.size << " at " << placement.offset.x;
      }
    EXPECT_GE(tally.rays, total * 9 / 10);
  }
};

// All shape types together trace more than a million rays in each precision.
TEST_P(SecondaryRays, AvoidsSelfIntersectionInDouble) {
  covers("A16 A17 A11");
  check<double>(150'000);
}
TEST_P(SecondaryRays, AvoidsSelfIntersectionInFloat) {
  covers("A16");
  check<float>(150'000);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SecondaryRays, testing::ValuesIn(shape_names()), parameter_name);

TEST(Step, StaysBelowTwoNanometresAt1000Kilometres) {
  covers("A17");
  for (const std::string& type : shape_names())
    for (const Json& object : shape_samples(type)) {
      const Placement far{1, Vec3d(1e6, -1e6, 1e6)};
      const Json scene = scene_with(far.of(object));
      const Target<double> shape(scene);
      for (const auto& ray : rays_at<double>(object, far, 200, 3)) {
        const auto hit = shape.closest(ray);
        if (!hit.met()) continue;
        const auto spot = shape.surface(ray, hit);
        const double largest = std::max(1e6 + 1, max_component(abs(spot.position)));
        EXPECT_LE(spot.step, 8.01 * std::numeric_limits<double>::epsilon() * largest) << object;
        if (largest < 1.1e6) {
          EXPECT_LE(spot.step, 2e-9) << object;
        }
      }
    }
}

}  // namespace
}  // namespace orrery::test
