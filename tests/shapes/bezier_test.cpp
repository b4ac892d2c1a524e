#include <gtest/gtest.h>

#include <cmath>

#include "core/shapes/bezier_kernel.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/surfaces.h"

// Compares Bezier patches with de Casteljau's algorithm in long double, which shares no code with the
// renderer.
namespace orrery::test {
namespace {

// Bezier patch and its points in long double.
struct PatchSpec {
  int degree_u, degree_v;
  std::vector<Vec3d> points;
  std::vector<double> weights;

  Json object() const {
    Json list = Json::array();
    for (const Vec3d& p : points) list.push_back(numbers(p));
    return {{"type", "patch"},
            {"degree_u", degree_u},
            {"degree_v", degree_v},
            {"points", list},
            {"weights", weights}};
  }

  // Returns a wavy sheet over [-1, 1]^2 with random heights and weights.
  static PatchSpec random(Random& random, int degree_u, int degree_v) {
    PatchSpec spec{degree_u, degree_v, {}, {}};
    for (int j = 0; j <= degree_v; ++j)
      for (int i = 0; i <= degree_u; ++i) {
        spec.points.push_back(Vec3d(2.0 * i / degree_u - 1, 2.0 * j / degree_v - 1, 0) + random.in_cube(0.3));
        spec.weights.push_back(random.between(0.5, 1.5));
      }
    return spec;
  }

  // Returns the homogeneous point x w, y w, z w, w.
  std::array<long double, 4> homogeneous(long double u, long double v) const {
    std::vector<std::array<long double, 4>> column;
    for (int j = 0; j <= degree_v; ++j) {
      std::vector<std::array<long double, 4>> row;
      for (int i = 0; i <= degree_u; ++i) {
        const auto k = static_cast<std::size_t>(j * (degree_u + 1) + i);
        const long double w = weights[k];
        row.push_back({points[k].x * w, points[k].y * w, points[k].z * w, w});
      }
      column.push_back(reduced_to_point(row, u));
    }
    return reduced_to_point(column, v);
  }
  Vec3<long double> at(long double u, long double v) const {
    const auto p = homogeneous(u, v);
    return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
  }
  Vec3<long double> normal(long double u, long double v) const {
    constexpr long double kStep = 1e-6L;
    return safe_normalize(cross(at(u + kStep, v) - at(u - kStep, v), at(u, v + kStep) - at(u, v - kStep)));
  }

 private:
  static std::array<long double, 4> reduced_to_point(std::vector<std::array<long double, 4>> row,
                                                     long double t) {
    while (row.size() > 1) {
      for (std::size_t i = 0; i + 1 < row.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) row[i][k] = row[i][k] * (1 - t) + row[i + 1][k] * t;
      row.pop_back();
    }
    return row[0];
  }
};

// Hit with the parameters of the patch.
template <class T>
struct PatchHit {
  T t, u, v;
  bool met;
};

template <class T>
std::vector<PatchHit<T>> patch_hits(const Json& object, const Rays<T>& rays) {
  std::vector<PatchHit<T>> found;
  for_each_surface<T>(*load(scene_with(object)), rays, [&](const auto& hits, const auto&, int i) {
    found.push_back({hits.t[i], hits.u[i], hits.v[i], hits.primitive[i] != kNoPrimitive});
  });
  return found;
}

// Aims rays at points of random patches, a third of them at edges of pieces. Each ray must hit the patch
// there or before. The patch's point at the reported parameters must be on the ray at the reported distance.
template <class T>
void check_patches(const char* type) {
  Random random(1);
  const int patches = exhaustive() ? 50 : 6, rays = exhaustive() ? 2'000 : 500;
  long double worst = 0;
  int missed = 0;
  for (int k = 0; k < patches; ++k) {
    const PatchSpec spec =
        PatchSpec::random(random, 1 + random.below(kMaxBezierDegree), 1 + k % kMaxBezierDegree);
    Rays<T> cast;
    std::vector<long double> reach;
    for (int i = 0; i < rays; ++i) {
      const auto part = [&] { return i % 3 ? random.unit() : random.below(17) / 16.0; };
      const Vec3d target(spec.at(part(), part()));
      const Vec3d direction = random.direction();
      reach.push_back(random.magnitude(0.1, 10));
      cast.push_back(
          convert_ray<T>(Ray<double>{target - direction * static_cast<double>(reach.back()), direction}));
    }
    const auto hits = patch_hits<T>(spec.object(), cast);
    for (std::size_t i = 0; i < cast.size(); ++i) {
      const auto ray = convert_ray<long double>(cast[i]);
      const long double unit =
          static_cast<long double>(std::numeric_limits<T>::epsilon()) * (max_component(abs(ray.origin)) + 2);
      // Rounding may move a ray at the border of the patch out of it.
      if (!hits[i].met || static_cast<long double>(hits[i].t) > reach[i] * (1 + 1e-4L)) {
        ++missed;
        continue;
      }
      const auto p = spec.at(static_cast<long double>(hits[i].u), static_cast<long double>(hits[i].v));
      worst = std::max(worst, length(ray.at(static_cast<long double>(hits[i].t)) - p) / unit);
    }
  }
  std::printf("Bezier patches in %s: largest error %.2Lf rounding units, %d of %d rays miss at the border\n",
              type, worst, missed, patches * rays);
  EXPECT_LE(worst, 16);
  EXPECT_LE(missed, patches * rays / 50);  // a tenth of the rays are at the border
}

TEST(Bezier, MatchesDeCasteljauInFloat) { check_patches<float>("float"); }
TEST(Bezier, MatchesDeCasteljauInDouble) { check_patches<double>("double"); }

// Rays at edges of pieces inside the patch never miss.
TEST(Bezier, HasNoGapsBetweenPieces) {
  Random random(2);
  for (int k = 0; k < (exhaustive() ? 100 : 10); ++k) {
    const PatchSpec spec = PatchSpec::random(random, 3, 3);
    Rays<double> cast;
    Rays<float> in_float;
    for (int i = 0; i < 1'000; ++i) {
      const double u = (1 + random.below(31)) / 32.0,
                   v = i % 2 ? (1 + random.below(31)) / 32.0 : random.between(0.1, 0.9);
      const Vec3d direction = random.direction_above(Vec3d(spec.normal(u, v)));
      cast.push_back({Vec3d(spec.at(u, v)) - direction * 5.0, direction});
      in_float.push_back(convert_ray<float>(cast.back()));
    }
    const Target<double> target(scene_with(spec.object()));
    for (const auto& hit : target.closest(cast)) EXPECT_TRUE(hit.met());
    const Target<float> small(scene_with(spec.object()));
    for (const auto& hit : small.closest(in_float)) EXPECT_TRUE(hit.met());
  }
}

TEST(Bezier, MatchesNormalsOfDeCasteljau) {
  Random random(3);
  for (int k = 0; k < 10; ++k) {
    const PatchSpec spec = PatchSpec::random(random, 2 + k % 3, 3);
    const Target<double> target(scene_with(spec.object()));
    for (int i = 0; i < 100; ++i) {
      const double u = random.between(0.01, 0.99), v = random.between(0.01, 0.99);
      const Vec3d normal(spec.normal(u, v)), point(spec.at(u, v));
      const Ray<double> ray{point + normal * 1e-3, -normal};
      const auto hit = target.closest(ray);
      ASSERT_TRUE(hit.met());
      EXPECT_LE(length(target.surface(ray, hit).outward() - normal), 1e-8);
    }
  }
}

TEST(Bezier, IsExactOnPlanes) {
  const auto plane = Target<double>::of_objects(
      "[{'type': 'patch', 'degree_u': 1, 'degree_v': 1, 'points': [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, "
      "1, 0]]}]");
  Random random(4);
  for (int i = 0; i < 1'000; ++i) {
    const Ray<double> ray{{random.between(-1, 1), random.between(-1, 1), 2}, {0, 0, -1}};
    const auto hit = plane.closest(ray);
    ASSERT_EQ(hit.t, 2);
    ASSERT_EQ(plane.surface(ray, hit).outward(), Vec3d(0, 0, 1));
  }
  EXPECT_TRUE(plane.closest(Ray<double>{{1, 1, 2}, {0, 0, -1}}).met()) << "at a corner";
  EXPECT_FALSE(plane.closest(Ray<double>{{1 + 1e-14, 0, 2}, {0, 0, -1}}).met()) << "just outside an edge";
  EXPECT_FALSE(plane.closest(Ray<double>{{-3, 0, 1e-14}, {1, 0, 0}}).met()) << "parallel";
}

TEST(Bezier, ContainsPatchInBoundsOfPieces) {
  Random random(5);
  for (int k = 0; k < 10; ++k) {
    const PatchSpec spec = PatchSpec::random(random, 3, 1 + k % 4);
    const Target<double> target(scene_with(spec.object()));
    for (int i = 0; i < (exhaustive() ? 10'000 : 500); ++i) {
      const Vec3d point(spec.at(random.unit(), random.unit()));
      bool inside = false;
      for (int p = 0; p < target.primitive_count(); ++p)
        inside = inside || padded<double>(target.bounds(p)).contains(point);
      ASSERT_TRUE(inside);
    }
  }
}

TEST(Bezier, IsScaleInvariant) {
  covers("A19");
  Random random(6);
  const PatchSpec spec = PatchSpec::random(random, 3, 3);
  const Target<double> patch(scene_with(spec.object()));
  for (const double factor : {0x1p-20, 0x1p20}) {
    const Target<double> other(scene_with(placed(spec.object(), factor, {})));
    for (int i = 0; i < 500; ++i) {
      const Vec3d direction = random.direction(), origin = random.in_cube(1) - direction * 3.0;
      const auto hit = patch.closest(Ray<double>{origin, direction});
      const auto scaled_hit = other.closest(Ray<double>{origin * factor, direction});
      ASSERT_EQ(hit.met(), scaled_hit.met());
      ASSERT_EQ(hit.t * factor, scaled_hit.t);
    }
  }
}

// A parabolic cylinder z = x^2, and rays along x that touch it, cross it, or pass below.
TEST(Bezier, DecidesTangentRays) {
  covers("A23 A24");
  const auto valley = Target<double>::of_objects(
      "[{'type': 'patch', 'degree_u': 2, 'degree_v': 1, 'points': [[-1, -1, 1], [0, -1, -1], [1, -1, 1], "
      "[-1, 1, 1], [0, 1, -1], "
      "[1, 1, 1]]}]");
  const auto hit = [&](double z) { return valley.closest(Ray<double>{{-3, 0.1, z}, {1, 0, 0}}); };
  EXPECT_NEAR(hit(0).t, 3, 1e-6);
  for (const double z : {1e-14, 1e-12, 1e-9, 1e-6, 0.1}) {
    EXPECT_NEAR(hit(z).t, 3 - std::sqrt(z), 2e-15 / std::sqrt(z) + 1e-15) << z;
    EXPECT_FALSE(hit(-z).met()) << z;
  }
}

// The edge v = 1 of the patch is the point (1, 0, 0).
TEST(Bezier, HasNormalsAtPoles) {
  covers("A26");
  const auto cap = Target<double>::of_objects(
      "[{'type': 'patch', 'degree_u': 1, 'degree_v': 2, 'points': [[0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, "
      "1], [1, 0, 0], [1, 0, 0]]}]");
  for (const double away : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
    const Ray<double> ray{{3, away, away}, {-1, 0, 0}};
    const auto hit = cap.closest(ray);
    ASSERT_TRUE(hit.met()) << away;
    EXPECT_NEAR(hit.t, 2 + away * away, 1e-15);
    EXPECT_LE(length(cross(cap.surface(ray, hit).geometric, Vec3d(1, 0, 0))), 1e-6 + 4 * away) << away;
  }
}

// At the parameters of a pole, a derivative is 0.
TEST(Bezier, HasNormalsAtParametersOfPoles) {
  covers("A26");
  const std::array<double, 18> net{0, 0, 1, 1, 1, 1, 1, 0, 1,
                                   0, 0, 0, 0, 1, 0, 1, 0, 0};  // x, y, z of the patch above
  BezierPiece<double> piece{};
  piece.degrees = {1, 2};
  piece.radius = 1;
  for (const double u : {0.0, 0.3, 1.0})
    for (const double v : {1.0, 1 - 1e-15, 1 - 1e-9}) {
      const BezierPoint<double> point = bezier_point<double>(piece, net.data(), u, v);
      const Vec3d normal = bezier_normal<double>(piece, net.data(), u, v, point);
      EXPECT_LE(length(normal - Vec3d(1, 0, 0)), 1e-6) << u << " " << v;
    }
}

}  // namespace
}  // namespace orrery::test
