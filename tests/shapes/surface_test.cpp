#include <gtest/gtest.h>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Tests position and orientation of the surface that every registered shape reports at a hit.
namespace orrery::test {
namespace {

using Vec = Vec3<long double>;
using Exact = Target<long double>;

template <class T>
constexpr long double kUlp = std::numeric_limits<T>::epsilon();

// One shape at one placement, with rays that hit it and the surface points of the hits.
template <class T>
struct PlacedShape {
  Json scene;
  Target<T> shape;
  Exact exact;
  Rays<T> rays;
  std::vector<Hit<T>> hits;
  std::vector<SurfaceSample<T>> spots;

  PlacedShape(const Json& object, const Placement& placement, int count)
      : scene(scene_with(placement.of(object))), shape(scene), exact(scene) {
    for (const auto& ray : rays_at<T>(object, placement, count, 17))
      if (shape.closest(ray).met()) rays.push_back(ray);
    hits = shape.closest(rays);
    spots = shape.surfaces(rays, hits);
  }
  long double magnitude(std::size_t i, const Placement& placement) const {
    return std::max(static_cast<long double>(placement.magnitude()),
                    max_component(abs(Vec(spots[i].position))));
  }
};

class ShapeSurface : public testing::TestWithParam<std::string> {
 protected:
  // Calls check(sitting, placement) for every sample of the type at every placement.
  template <class T, class Check>
  void for_each_placed_shape(int rays, const Check& check) {
    for (const Json& object : shape_samples(GetParam()))
      for (const Placement& placement : placements<T>()) {
        SCOPED_TRACE(object.dump() + " of size " + std::to_string(placement.size) + " at " +
                     std::to_string(placement.offset.x));
        const PlacedShape<T> sitting(object, placement, rays);
        EXPECT_GT(sitting.hits.size(), static_cast<std::size_t>(rays / 20));
        check(sitting, placement);
      }
  }

  // Positions are accurate to 8 ulp of the largest coordinate. Normals face the ray, and their length is 1 to
  // 4 ulp.
  template <class T>
  void check_positions() {
    for_each_placed_shape<T>(1000, [](const PlacedShape<T>& s, const Placement& placement) {
      int off = 0, turned = 0, long_or_short = 0;
      for (std::size_t i = 0; i < s.hits.size(); ++i) {
        const Vec normal(s.spots[i].geometric), shading(s.spots[i].normal), at(s.spots[i].position);
        const long double reach = 8 * kUlp<T> * s.magnitude(i, placement);
        const auto hit = s.exact.closest(Ray<long double>{at + normal * (2 * reach), -normal});
        const auto beside = [&](const Vec& shift) {  // for hits at an edge
          return s.exact.closest(Ray<long double>{at + normal * (2 * reach) + shift, -normal});
        };
        bool on = hit.met() && hit.t <= 3 * reach;
        for (const Vec& axis : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1)})
          for (const long double sign : {1.0L, -1.0L})
            if (!on) on = beside(axis * (sign * reach)).t <= 3 * reach;
        off += !on;
        turned += dot(s.spots[i].geometric, s.rays[i].direction) > 0;
        long_or_short +=
            std::abs(length(normal) - 1) > 4 * kUlp<T> || std::abs(length(shading) - 1) > 4 * kUlp<T>;
      }
      EXPECT_EQ(off, 0) << "positions are off the surface";
      EXPECT_EQ(turned, 0) << "normals face away from the ray";
      EXPECT_EQ(long_or_short, 0) << "normals are not of unit length";
    });
  }
};

TEST_P(ShapeSurface, KeepsFloatPositionsOnShape) { check_positions<float>(); }
TEST_P(ShapeSurface, KeepsDoublePositionsOnShape) { check_positions<double>(); }

// Secants to neighbouring points of the surface, found by other rays, are perpendicular to the normal.
TEST_P(ShapeSurface, GivesPerpendicularNormals) {
  for_each_placed_shape<double>(1000, [](const PlacedShape<double>& s, const Placement& placement) {
    const long double h = 1e-6L * static_cast<long double>(placement.size);
    int judged = 0, slanted = 0;
    for (std::size_t i = 0; i < s.hits.size(); ++i) {
      const auto ray = convert_ray<long double>(s.rays[i]);
      const Vec normal(s.spots[i].geometric);
      if (std::abs(dot(normal, ray.direction)) < 0.3L) continue;
      const Vec across = Vec(perpendicular(Vec3d(ray.direction))), other = cross(across, ray.direction);
      const Rays<long double> near = {
          ray, {ray.origin + across * h, ray.direction}, {ray.origin + other * h, ray.direction}};
      const auto hits = s.exact.closest(near);
      const auto spots = s.exact.surfaces(near, hits);
      bool same_face = true;
      for (std::size_t k = 0; k < 3; ++k)
        same_face = same_face && hits[k].met() && dot(spots[k].geometric, normal) > 0.999L;
      if (!same_face) continue;
      ++judged;
      // On a curved surface, the angle between secant and tangent is h / (2 radius of curvature), where the
      // radius is at least 1/16 of the size.
      for (std::size_t k = 1; k < 3; ++k) {
        const Vec secant = near[k].at(hits[k].t) - near[0].at(hits[0].t);
        slanted += std::abs(dot(secant, normal)) > 1e-4L * length(secant);
      }
    }
    EXPECT_EQ(slanted, 0);
    EXPECT_GT(judged, 20);
  });
}

// An outward ray from a closed convex shape misses the shape, and a ray from just inside hits the surface
// again.
TEST_P(ShapeSurface, OrientsNormalsOfClosedShapesOutward) {
  covers("A38");
  for_each_placed_shape<double>(1000, [](const PlacedShape<double>& s, const Placement& placement) {
    if (!s.shape.traits(0).closed || !s.shape.traits(0).convex) return;
    const long double h = 1e-3L * static_cast<long double>(placement.size);
    for (std::size_t i = 0; i < s.hits.size(); ++i) {
      const Vec outward(s.spots[i].outward()), at(s.spots[i].position);
      EXPECT_FALSE(s.exact.closest(Ray<long double>{at + outward * h, outward}).met());
      EXPECT_TRUE(s.exact.closest(Ray<long double>{at - outward * h, outward}).met());
    }
  });
}

TEST_P(ShapeSurface, ContainsEveryPositionInBounds) {
  for_each_placed_shape<float>(500, [](const PlacedShape<float>& s, const Placement&) {
    for (std::size_t i = 0; i < s.hits.size(); ++i) {
      const Bounds<float> box = padded<float>(s.shape.bounds(s.hits[i].primitive));
      const Vec3f& p = s.spots[i].position;
      EXPECT_TRUE(p.x >= box.lo.x && p.y >= box.lo.y && p.z >= box.lo.z) << p.x << " " << p.y << " " << p.z;
      EXPECT_TRUE(p.x <= box.hi.x && p.y <= box.hi.y && p.z <= box.hi.z) << p.x << " " << p.y << " " << p.z;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapeSurface, testing::ValuesIn(shape_names()), parameter_name);

// Open shapes face as specified in their input.
TEST(OpenShapes, KeepsSpecifiedOrientation) {
  const auto outward = [](std::string_view object, const Vec3d& from, const Vec3d& direction) {
    const auto shape = Target<double>::of_objects(object);
    const Ray<double> ray{from, direction};
    return shape.surface(ray, shape.closest(ray)).outward();
  };
  for (const double side : {1.0, -1.0}) {  // seen from the front and from the back
    const Vec3d from(0.1, 0.2, 5 * side), direction(0, 0, -side);
    EXPECT_EQ(outward("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 3]}]", from, direction),
              Vec3d(0, 0, 1));
    EXPECT_EQ(outward("[{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, -2], 'radius': 1}]", from,
                      direction),
              Vec3d(0, 0, -1));
    EXPECT_EQ(
        outward("[{'type': 'triangle', 'vertices': [[-1, -1, 0], [1, -1, 0], [0, 2, 0]]}]", from, direction),
        Vec3d(0, 0, 1));
    EXPECT_EQ(
        outward(
            "[{'type': 'mesh', 'positions': [[-1, -1, 0], [0, 2, 0], [1, -1, 0]], 'indices': [[0, 1, 2]]}]",
            from, direction),
        Vec3d(0, 0, -1));
  }
}

TEST(Mesh, InterpolatesNormalsUnlessTheyCancel) {
  const auto shape = Target<double>::of_objects(
      R"([{'type': 'mesh', 'positions': [[0, 0, 0], [1, 0, 0], [0, 1, 0]], 'indices': [[0, 1, 2]],
           'normals': [[-1, 0, 1], [1, 0, 1], [0, 0, 1]]},
          {'type': 'mesh', 'positions': [[5, 0, 0], [6, 0, 0], [5, 1, 0]], 'indices': [[0, 1, 2]],
           'normals': [[1, 0, 0], [-1, 0, 0], [0, 1, 0]]}])");
  const auto normal_at = [&](double x, double y) {
    const Ray<double> ray{{x, y, 1}, {0, 0, -1}};
    return shape.surface(ray, shape.closest(ray)).normal;
  };
  EXPECT_NEAR(normal_at(0.5, 1e-9).x, 0, 1e-9);
  EXPECT_NEAR(normal_at(1e-9, 1e-9).x, -std::sqrt(0.5), 1e-8);
  EXPECT_NEAR(normal_at(0.25, 1e-9).x, -0.5 / std::sqrt(0.5 + 0.5 * 0.5 + 0.25), 0.1);
  EXPECT_EQ(normal_at(5.5, 0), Vec3d(0, 0, 1)) << "normals that cancel are replaced by the flat normal";
}

}  // namespace
}  // namespace orrery::test
