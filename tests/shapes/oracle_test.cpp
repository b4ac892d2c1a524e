#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/shapes.h"

// Compares every registered shape, in float and in double, with its own formula in long double. The criterion
// is backward stability: a result must be exact for some ray within a few ulp of the input. Near a
// silhouette, only differences that rounding of the input explains are accepted.
namespace orrery::test {
namespace {

using Vec = Vec3<long double>;

// Offset of the shifted rays and tolerance for hits, in ulp of the largest coordinate.
constexpr int kShift = 8;

template <class T>
constexpr long double kUlp = std::numeric_limits<T>::epsilon();

// Adds the ray and twelve copies. In a copy, the origin is moved along an axis or the direction is turned
// towards an axis, in either sense.
constexpr std::size_t kCopies = 13;
void add_copies(const Ray<long double>& ray, long double shift, long double turn, Rays<long double>& rays) {
  rays.push_back(ray);
  for (const Vec& axis : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1)})
    for (const long double sign : {1.0L, -1.0L}) {
      rays.push_back({ray.origin + axis * (sign * shift), ray.direction});
      rays.push_back({ray.origin, ray.direction + axis * (sign * turn)});
    }
}

// Number of copies that hit, and range of their distances.
struct Range {
  long double low = std::numeric_limits<long double>::infinity(), high = -low;
  std::size_t hits = 0;

  void add(const Hit<long double>& hit) {
    if (!hit.met()) return;
    ++hits;
    low = std::min(low, hit.t);
    high = std::max(high, hit.t);
  }
  bool unanimous() const { return hits == 0 || hits == kCopies; }
};

// Returns true if the shape has a surface within `reach` of the point. Probes run along the normal through
// the point and through nearby points, because a hit may be just beyond an edge.
bool lies_on(const Target<long double>& shape, const Vec& point, const Vec& normal, long double reach) {
  Rays<long double> probes;
  for (const Vec& shift :
       {Vec(), Vec(1, 0, 0), Vec(-1, 0, 0), Vec(0, 1, 0), Vec(0, -1, 0), Vec(0, 0, 1), Vec(0, 0, -1)})
    probes.push_back({point + shift * reach + normal * (2 * reach), -normal});
  const auto hits = shape.closest(probes);
  return std::any_of(hits.begin(), hits.end(),
                     [&](const auto& hit) { return hit.met() && hit.t <= 4 * reach; });
}

struct Verdict {
  int rays = 0, undecided = 0, wrong = 0;
};

template <class T>
Verdict judge(const Json& object, const Placement& placement, int count, std::uint64_t seed) {
  const Json scene = scene_with(placement.of(object));
  const Target<T> shape(scene);
  const Target<long double> exact_shape(scene);
  const Rays<T> rays = rays_at<T>(object, placement, count, seed);
  const std::vector<Hit<T>> found = shape.closest(rays);
  Rays<long double> copies;
  std::vector<long double> shifts;
  for (const auto& ray : rays) {
    const auto exact = convert_ray<long double>(ray);
    const auto largest =
        std::max(static_cast<long double>(placement.magnitude()), max_component(abs(exact.origin)));
    shifts.push_back(kShift * kUlp<T> * largest);
    add_copies(exact, shifts.back(), kShift * kUlp<T>, copies);
  }
  const std::vector<Hit<long double>> exact = exact_shape.closest(copies);
  Verdict verdict{count};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Range range;
    for (std::size_t copy = 0; copy < kCopies; ++copy) range.add(exact[kCopies * i + copy]);
    verdict.undecided += !range.unanimous();
    if (!range.unanimous()) continue;
    if (!found[i].met()) {
      verdict.wrong += range.hits > 0;
      continue;
    }
    const auto t = static_cast<long double>(found[i].t);
    const long double reach = shifts[i] + kShift * kUlp<T> * t;
    if (range.hits > 0 && t >= range.low - reach && t <= range.high + reach) continue;
    const Vec normal(shape.surface(rays[i], found[i]).geometric);
    verdict.wrong += !lies_on(exact_shape, copies[kCopies * i].at(t), normal, reach);
  }
  return verdict;
}

class ShapeOracle : public testing::TestWithParam<std::string> {
 protected:
  const int kRays = exhaustive() ? 100'000 : 5'000;  // for each shape type and precision

  template <class T>
  void check() {
    const auto& samples = shape_samples(GetParam());
    const auto places = placements<T>();
    const int each = kRays / static_cast<int>(samples.size() * places.size()) + 1;
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (std::size_t p = 0; p < places.size(); ++p) {
        const Verdict verdict = judge<T>(samples[s], places[p], each, 100 * s + p);
        EXPECT_EQ(verdict.wrong, 0) << samples[s] << " of size " << places[p].size << " at "
                                    << places[p].offset.x;
        EXPECT_LT(verdict.undecided, verdict.rays / 4) << "too many rays are undecided";
      }
  }
};

TEST_P(ShapeOracle, MatchesLongDoubleInFloat) {
  covers("A1 A2");
  check<float>();
}
TEST_P(ShapeOracle, MatchesLongDoubleInDouble) {
  covers("A1 A2");
  check<double>();
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapeOracle, testing::ValuesIn(shape_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
