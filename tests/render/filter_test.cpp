#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests images rendered with each pixel filter.
namespace orrery::test {
namespace {

RenderRequest filtered(Filter filter, int samples, RenderRequest request, const char* technique = "path") {
  request.filter = filter;
  request.samples = samples;
  request.technique = technique;
  return request;
}
constexpr std::array kAll{Filter::box, Filter::gaussian, Filter::blackman_harris, Filter::mitchell,
                          Filter::lanczos};

TEST(Filters, KeepsConstantImage) {
  covers("light-46");
  const Json scene =
      scene_of("[{'type': 'sphere', 'center': [0, 0, 900], 'radius': 1}]", "{'background': [0.7, 0.3, 1.7]}");
  for (const Filter filter : kAll)
    for (const int samples : {2, 4, 16, 64})
      for (const char* technique : {"whitted", "distributed", "path"}) {
        const Picture picture = render(scene, filtered(filter, samples, size(40, 24), technique));
        const float tolerance = filter == Filter::mitchell || filter == Filter::lanczos ? 1e-6f : 0;
        for (const Vec3f& pixel : picture.pixels) {
          ASSERT_NEAR(pixel.x, 0.7f, tolerance) << name_of(filter) << " " << samples << technique;
          ASSERT_NEAR(pixel.y, 0.3f, tolerance);
          ASSERT_NEAR(pixel.z, 1.7f, 2 * tolerance);
        }
      }
}

double height(Filter filter, double x) {
  constexpr double pi = std::numbers::pi;
  x = std::abs(x);
  switch (filter) {
    case Filter::box: return x <= 0.5;
    case Filter::gaussian: return x <= 1.5 ? std::exp(-2 * x * x) : 0;
    case Filter::blackman_harris:
      return x > 1.5 ? 0
                     : 0.35875 + 0.48829 * std::cos(2 * pi * x / 3) + 0.14128 * std::cos(4 * pi * x / 3) +
                           0.01168 * std::cos(2 * pi * x);
    case Filter::mitchell:
      return x < 1   ? (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6
             : x < 2 ? (-7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6
                     : 0;
    case Filter::lanczos:
      return x == 0 ? 1 : x < 3 ? std::sin(pi * x) * std::sin(pi * x / 3) * 3 / (pi * pi * x * x) : 0;
  }
  return 0;
}

// The radiance across the edge of a half plane is the integral of the filter. Filters with negative lobes
// cause ringing.
TEST(Filters, EdgeProfileMatchesFilterIntegral) {
  covers("light-46");
  Json scene = scene_of(
      "[{'type': 'rectangle', 'corner': [0.3, -100, 0], 'edge_u': [100, 0, 0], 'edge_v': [0, 200, 0], "
      "'material': "
      "'lamp'}]",
      "{'camera': {'type': 'orthographic', 'eye': [0, 0, 4], 'look_at': [0, 0, 0], 'height': 16}, "
      "'materials': {'lamp': {'type': 'lambert', "
      "'emission': [1, 1, 1]}}}");
  for (const Filter filter : kAll) {
    const Picture picture = render(scene, filtered(filter, 256, size(16, 16)));
    double whole = 0;
    for (int k = -30'000; k < 30'000; ++k) whole += height(filter, (k + 0.5) / 10'000);
    for (int x = 0; x < 16; ++x) {
      double part = 0, mean = 0;
      for (int k = -30'000; k < 30'000; ++k)
        if (x - 7.5 + (k + 0.5) / 10'000 > 0.3) part += height(filter, (k + 0.5) / 10'000);
      for (int y = 0; y < 16; ++y) mean += double{picture.at(x, y).x} / 16;
      EXPECT_NEAR(mean, part / whole, 1e-3) << name_of(filter) << " at " << x;
    }
  }
}

// Neither the number of threads nor the scale of the scene changes the image. A single sample of Whitted's
// technique is at the pixel centre, so the filter has no effect.
TEST(Filters, IsIndependentOfThreadsAndScale) {
  const Json own = sample("cornell-box");
  for (const Filter filter : {Filter::blackman_harris, Filter::lanczos}) {
    RenderRequest request = filtered(filter, 4, size(40, 40));
    request.max_depth = 3;
    const Picture expected = render(own, request);
    EXPECT_TRUE(identical(render(own, request, 1), expected));
    EXPECT_TRUE(identical(render(scaled(own, 0x1p-8), request), expected));
    RenderRequest one = filtered(filter, 1, size(40, 40), "whitted"), plain = one;
    plain.filter = Filter::box;
    EXPECT_TRUE(identical(render(own, one), render(own, plain)));
  }
}

}  // namespace
}  // namespace orrery::test
