#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/image/srgb.h"
#include "core/params/params.h"
#include "tests/support/pictures.h"

// Tests certificates of images in display space.
namespace orrery::test {
namespace {

RenderRequest on_a_display(int side, int samples) {
  RenderRequest r = size(side, side);
  r.space = Space::display;
  r.precision = Precision::double_precision;
  r.samples = samples;
  return r;
}

Bound bound_of(const char* subject, const Certificate& certificate) {
  for (const Certificate::Term& term : certificate.terms)
    if (term.subject == subject) return term.bound;
  throw Error(std::string("no term ") + subject);
}

constexpr const char *kCodes = "8-bit codes", *kClamp = "indirect light clamp";

// In a constant image all codes have the same error, at most half a code.
TEST(DisplayCertificate, MatchesCodeErrorOfConstantImage) {
  for (const float code : {127.5f, 127.25f, 127.0f, 0.0f, 255.0f}) {
    const std::string value = number_text(double{decode_srgb(code / 255)});
    const auto scene = load(scene_of("[{'type': 'sphere', 'center': [0, 0, 50], 'radius': 1}]",
                                     "{'background': [" + value + ", 0, 0]}"));
    const Bound bound = bound_of(kCodes, rendered(scene, on_a_display(40, 2)).certificate);
    EXPECT_NEAR(*bound.rms, std::fabs(code - std::round(code)) / 255 / std::sqrt(3.0), 1e-5) << code;
    EXPECT_NEAR(*bound.max, 0.5 / 255, 1e-5) << code;
  }
}

TEST(DisplayCertificate, MatchesCodeErrorOfFile) {
  const RenderResult made = rendered(load(sample("paper")), on_a_display(100, 4));
  const Image codes = made.film.image(PixelFormat::srgb8);
  std::vector<double> values;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      for (std::size_t c = 0; c < 3; ++c) values.push_back(double{codes.linear(x, y)[c]});
  const Bound bound = bound_of(kCodes, made.certificate);
  EXPECT_NEAR(*bound.rms, rms_difference(shown(values), shown(linear_values(made.film))), 2e-5);
  EXPECT_EQ(bound.kind, Bound::Kind::proved);
}

// A filter with negative lobes subtracts light in some pixels. This must not offset the light clamped in
// other pixels.
TEST(DisplayCertificate, BoundsClampUnderNegativeFilterLobes) {
  const auto scene = load(sample("cornell-box"));
  for (const Filter filter : {Filter::box, Filter::lanczos}) {
    RenderRequest r = on_a_display(48, 4);
    r.technique = "path";
    r.filter = filter;
    r.reuse = 1;
    const std::vector<double> all = linear_values(rendered(scene, r).film);
    r.clamp_indirect = 0.1;
    const RenderResult clamped = rendered(scene, r);
    const std::vector<double> some = linear_values(clamped.film);
    EXPECT_GE(*bound_of(kClamp, clamped.certificate).rms, rms_difference(shown(all), shown(some)));
    double away = 0;
    for (std::size_t i = 0; i < all.size(); ++i) away += std::fabs(all[i] - some[i]);
    EXPECT_NEAR(clamped.stats.clamped.pixels.mean(), away / static_cast<double>(all.size()), 1e-5);
  }
}

TEST(DisplayCertificate, IsExactForInactiveClamp) {
  RenderRequest r = on_a_display(32, 2);
  r.technique = "path";
  r.clamp_indirect = 1e6;
  const RenderResult made = rendered(load(sample("cornell-box")), r);
  EXPECT_EQ(bound_of(kClamp, made.certificate).kind, Bound::Kind::exact);
}

}  // namespace
}  // namespace orrery::test
