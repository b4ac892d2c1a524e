#include <gtest/gtest.h>

#include <algorithm>

#include "core/model/technique.h"
#include "core/render/progressive.h"
#include "tests/support/pictures.h"

// Tests renders whose samples are traced in several passes.
namespace orrery::test {
namespace {

RenderRequest of(int samples, const char* technique) {
  RenderRequest request = size(70, 45);  // includes partial tiles
  request.samples = samples;
  request.technique = technique;
  return request;
}

// Images and errors are equal bit for bit. With an emission pass, each pass first traces two more rays
// through the corners of each pixel.
TEST(ProgressiveRender, MatchesSinglePassRender) {
  for (const char* name : {"paper", "cornell-box", "open-shutter", "depth-of-field", "light-many"}) {
    for (const char* technique : {"whitted", "path", "distributed"}) {
      const auto scene = load(sample(name));
      const PreparedScene prepared(scene);
      const SettledPlan plan = settle(prepared, make_plan(*scene, of(12, technique)));
      ProgressiveRender progress(prepared, plan, shared_executor(), {});
      std::uint64_t corners = 0;
      for (const int samples : progressive_samples(*plan)) {
        progress.refine(samples);
        const Picture whole = render(scene, of(samples, technique));
        const Image image = progress.film().image(PixelFormat::linear32);
        for (int y = 0; y < whole.height; ++y)
          for (int x = 0; x < whole.width; ++x)
            ASSERT_EQ(image.linear(x, y), whole.at(x, y)) << name << " " << technique << " " << samples;
        const SampledError &told = progress.stats().error, &expected = whole.stats.error;
        EXPECT_EQ(told.known(), samples % 2 == 0);
        EXPECT_EQ(told.samples, expected.samples);
        EXPECT_EQ(told.pixel.rmse(), expected.pixel.rmse()) << name;
        EXPECT_EQ(told.block32.rmse(), expected.block32.rmse()) << name;
        const std::uint64_t rays = progress.stats().counts.rays.camera,
                            at_once = whole.stats.counts.rays.camera;
        EXPECT_LE(rays, at_once + corners) << name << " " << technique << " " << samples;
        if (plan->technique->draws_light) corners += 2 * image.bytes().size() / image.pixel_bytes();
      }
    }
  }
}

// The error does not depend on the order of tiles, nor on threads.
TEST(ProgressiveRender, ReportsErrorBitwiseReproducibly) {
  for (const char* name : {"cornell-box", "material-refractive", "outdoors"})
    for (const Space space : {Space::linear, Space::display}) {
      RenderRequest request = size(300, 200);
      request.samples = 4;
      request.technique = name == std::string("material-refractive") ? "whitted" : "path";
      request.max_depth = 2;
      request.clamp_indirect = 0.3;
      request.space = space;
      const auto scene = load(sample(name));
      const PreparedScene prepared(scene);
      const SettledPlan plan = settle(prepared, make_plan(*scene, request));
      const auto told = [&](int threads, bool spread) {
        ThreadExecutor executor(threads);
        ProgressiveRender progress(prepared, plan, executor, {});
        progress.refine(4, {.spread = spread});
        const RenderStats& stats = progress.stats();
        std::vector<double> all{
            stats.error.pixel.rmse(), stats.error.block4.rmse(),  stats.error.interval().high,
            stats.halves.mean(),      stats.halves.rounding(),    stats.halves.upper_mean(0.05, true),
            stats.omitted.mean(),     stats.omitted.rms(),        stats.omitted.max(),
            stats.clamped.mean(1),    stats.clamped.pixels.rms(), stats.clamped.standard_error(2)};
        for (const Certificate::Term& term : certify(*plan, stats).terms)
          all.push_back(term.bound.rms.value_or(-1));
        return all;
      };
      const auto alone = told(1, false);
      EXPECT_EQ(told(1, true), alone) << name;
      for (const int threads : {2, 3, 4}) EXPECT_EQ(told(threads, threads == 3), alone) << name << threads;
    }
}

TEST(ProgressiveRender, DoublesSamplesPerPass) {
  const auto scene = load(sample("paper"));
  const auto passes = [&](int samples, const char* technique) {
    return progressive_samples(make_plan(*scene, of(samples, technique)));
  };
  EXPECT_EQ(passes(64, "path"), (std::vector{1, 2, 4, 8, 16, 32, 64}));
  EXPECT_EQ(passes(100, "path"), (std::vector{1, 3, 6, 12, 25, 50, 100}));
  EXPECT_EQ(passes(64, "whitted"), (std::vector{2, 4, 8, 16, 32, 64}));
  EXPECT_EQ(passes(3, "whitted"), (std::vector{3}));
  EXPECT_EQ(passes(1, "whitted"), (std::vector{1}));
}

}  // namespace
}  // namespace orrery::test
