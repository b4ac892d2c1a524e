// Tests audits, which compare random pixels of an image with the full model.
#include "core/study/audit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/plan/options.h"
#include "tests/render/random_optics.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

Audit audited(const Json& scene, const RenderRequest& request, int pixels, std::uint64_t draw = 0) {
  const PreparedScene prepared(load(scene));
  return audit(prepared, request, pixels, draw, shared_executor());
}

// Returns the RMS error of a whole image due to limits on depth and weight.
double truth(const Json& scene, const RenderRequest& request) {
  RenderRequest whole = request;
  whole.precision = Precision::double_precision;
  whole.max_depth = 32;
  whole.min_contribution = 1e-4;
  const auto loaded = load(scene);
  return rms_difference(linear_values(rendered(loaded, request).film),
                        linear_values(rendered(loaded, whole).film));
}

TEST(Audit, BoundsTruncationErrorOfRandomScenes) {
  covers("certificate-1");
  Random random(11);
  int held = 0;
  for (int k = 0; k < 20; ++k) {
    const Json scene = random_optics(random);
    RenderRequest r = in_double(size(48, 48));
    r.technique = "whitted";
    r.samples = 2;
    r.max_depth = 1;
    const Audit found = audited(scene, r, 512, static_cast<std::uint64_t>(k));
    held += !found.bound.rms || *found.bound.rms >= truth(scene, r);
  }
  EXPECT_GE(held, 19) << "95 % of 20 images";
}

// At 4,000 km, where floats are half a metre apart, the edge of a ball is ragged. At 4 m it is nearly exact.
TEST(Audit, DetectsFloatErrors) {
  covers("certificate-11");
  const auto seen_from = [](double distance) {
    const Json scene = scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"),
                                  {{"ambient", {1, 1, 1}},
                                   {"camera",
                                    {{"type", "perspective"},
                                     {"eye", {0.3 * distance, 0.2 * distance, distance}},
                                     {"look_at", {0, 0, 0}},
                                     {"fov_degrees", 160 / distance}}}});
    RenderRequest r = in_float(size(128, 128));
    r.samples = 4;
    return audited(scene, r, 2048);
  };
  const Audit near = seen_from(4), far = seen_from(4e6);
  EXPECT_LT(near.rms, 1e-3);
  EXPECT_GT(far.rms, 10 * near.rms + 1e-3);
  EXPECT_GT(far.differing, 10 * std::max(1, near.differing));
}

// The objects are about as large as pixels: one sample per pixel reveals no error, but 64 samples do.
TEST(Audit, DetectsUndersampling) {
  covers("certificate-23");
  Json dots = json("[]");
  for (int x = 0; x < 24; ++x)
    for (int y = 0; y < 24; ++y)
      dots.push_back(
          {{"type", "sphere"}, {"center", {(x - 11.5) * 0.13, (y - 11.5) * 0.13, 0}}, {"radius", 0.04}});
  RenderRequest r = in_double(size(48, 48));
  const Json scene = scene_with(dots, {{"ambient", {1, 1, 1}}});
  const Audit found = audited(scene, r, 2048);
  RenderRequest many = r;
  many.samples = 64;
  const auto loaded = load(scene);
  const double error =
      rms_difference(linear_values(rendered(loaded, r).film), linear_values(rendered(loaded, many).film));
  EXPECT_GT(error, 0.05);
  EXPECT_NEAR(found.rms / error, 1, 0.2);
  EXPECT_GE(*found.bound.rms, error);
}

// A single pixel is wrong. The bound on the RMS error is small, but the maximum error has no bound.
TEST(Audit, BoundsErrorOfSingleWrongPixel) {
  covers("certificate-24");
  const Json scene =
      scene_of("[{'type': 'sphere', 'center': [0.02, 0.02, 0], 'radius': 0.004}]", "{'ambient': [1, 1, 1]}");
  const RenderRequest r = in_double(size(64, 64));
  const Audit found = audited(scene, r, 512);
  RenderRequest many = r;
  many.samples = 64;
  const auto loaded = load(scene);
  EXPECT_GE(*found.bound.rms, rms_difference(linear_values(rendered(loaded, r).film),
                                             linear_values(rendered(loaded, many).film)));
  EXPECT_FALSE(found.bound.max) << "pixels outside of the random sample may have any error";
}

TEST(Audit, ReportsZeroErrorForFullModel) {
  RenderRequest r = in_double(size(64, 64));
  r.max_depth = 32;
  r.min_contribution = 1e-4;
  r.samples = 2;
  const Audit found = audited(sample("glass"), r, 256);
  EXPECT_EQ(found.differing, 0);
  EXPECT_EQ(found.rms, 0);
}

TEST(Audit, RejectsBudgetsViewsAndLayers) {
  RenderRequest r = size(32, 32);
  r.error = 0.1;
  EXPECT_THROW(audited(sample("paper"), r, 1), InputError);
  r.error.reset();
  r.view = View::bound;
  EXPECT_THROW(audited(sample("paper"), r, 1), InputError);
  r.view.reset();
  r.layers = std::vector<std::string>{"depth"};
  EXPECT_THROW(audited(sample("paper"), r, 1), InputError);
}

}  // namespace
}  // namespace orrery::test
