#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/covers.h"
#include "tests/support/shapes.h"

// Tests the parts of the ray contract that do not depend on a shape's formula: ranges, ties, lanes, and
// invalid rays.
namespace orrery::test {
namespace {

class RayContract : public testing::TestWithParam<std::string> {
 protected:
  template <class T, class Check>
  void for_each_sample(const Check& check) {
    for (const Json& object : shape_samples(GetParam())) {
      SCOPED_TRACE(object.dump());
      check(scene_with(object), rays_at<T>(object, {1, Vec3d()}, 2000, 9));
    }
  }

  template <class T>
  void check_bad_rays() {
    const T nan = std::numeric_limits<T>::quiet_NaN(), infinity = std::numeric_limits<T>::infinity();
    for_each_sample<T>([&](const Json& scene, const Rays<T>& rays) {
      const Target<T> shape(scene);
      for (std::size_t i = 0; i < rays.size(); i += 50)
        for (const T bad : {nan, infinity, -infinity})
          for (int component = 0; component < 6; ++component) {
            Ray<T> ray = rays[i];
            Vec3<T>& v = component < 3 ? ray.origin : ray.direction;
            (component % 3 == 0 ? v.x : component % 3 == 1 ? v.y : v.z) = bad;
            const auto hit = shape.closest(ray);
            EXPECT_FALSE(std::isnan(hit.t)) << bad << " as component " << component;
            if (std::isnan(bad)) {
              EXPECT_FALSE(hit.met()) << bad << " as component " << component;
            }
          }
      EXPECT_FALSE(shape.closest(Ray<T>{rays[0].origin, Vec3<T>()}).met()) << "zero direction";
    });
  }

  // Expects closest() and occlude() to agree on every ray. A ray that ends exactly at a hit is not occluded.
  template <class T>
  void check_occlusion() {
    for_each_sample<T>([&](const Json& scene, const Rays<T>& rays) {
      const Target<T> shape(scene);
      const auto hits = shape.closest(rays);
      const auto occluded = shape.occluded(rays, std::numeric_limits<T>::infinity());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].met(), occluded[i] != 0);
        if (!hits[i].met()) continue;
        const std::span one(&rays[i], 1);
        EXPECT_FALSE(shape.occluded(one, hits[i].t)[0]) << "t_max is exclusive";
        EXPECT_TRUE(shape.occluded(one, std::nextafter(hits[i].t, std::numeric_limits<T>::infinity()))[0]);
      }
    });
  }

  // Expects the same result for a ray in any lane and with any neighbours.
  template <class T>
  void check_lanes() {
    for_each_sample<T>([&](const Json& scene, const Rays<T>& rays) {
      const Target<T> shape(scene);
      const auto together = shape.closest(rays);
      const auto spots = shape.surfaces(rays, together);
      for (std::size_t i = 0; i < rays.size(); i += 7) {
        const auto alone = shape.closest(rays[i]);
        EXPECT_EQ(alone.t, together[i].t);
        EXPECT_EQ(alone.primitive, together[i].primitive);
        if (!alone.met()) continue;
        EXPECT_EQ(shape.surface(rays[i], alone).position, spots[i].position);
      }
    });
  }
};

TEST_P(RayContract, MissesInvalidRays) {
  covers("A36");
  check_bad_rays<float>();
  check_bad_rays<double>();
}
TEST_P(RayContract, AgreesOnOcclusionAndNearestHit) {
  check_occlusion<float>();
  check_occlusion<double>();
}
TEST_P(RayContract, IsIndependentOfLanes) {
  check_lanes<float>();
  check_lanes<double>();
}

// For three copies of an object, the lowest primitive number wins in any order of the intersection tests.
TEST_P(RayContract, BreaksTiesByLowestNumber) {
  for (const Json& object : shape_samples(GetParam())) {
    const Target<double> one(scene_with(object));
    const Target<double> three(scene_with(Json::array({object, object, object})));
    std::vector<int> backwards;
    for (int i = three.primitive_count(); i-- > 0;) backwards.push_back(i);
    const auto rays = rays_at<double>(object, {1, Vec3d()}, 1000, 9);
    const auto expected = one.closest(rays), forwards = three.closest(rays),
               reversed = three.closest(rays, backwards);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(forwards[i].primitive, expected[i].primitive);
      EXPECT_EQ(reversed[i].primitive, expected[i].primitive);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RayContract, testing::ValuesIn(shape_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
