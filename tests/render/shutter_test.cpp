#include <gtest/gtest.h>

#include <cmath>

#include "core/accelerators/registry.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Compares images rendered with an open shutter with closed forms.
namespace orrery::test {
namespace {

RenderRequest open_for(double seconds, int samples, RenderRequest request) {
  request.shutter = seconds;
  request.samples = samples;
  request.technique = "path";
  return request;
}

// Returns an emissive object under an orthographic camera. Pixels are 1 m wide, and the origin is at the
// image centre.
Json seen_from_above(const Json& object, double pixels) {
  return scene_of(
      "[{'type': 'sphere', 'center': [0, 0, -500], 'radius': 1, 'material': 'white'}]",
      R"({'camera': {'type': 'orthographic', 'eye': [0, 0, 50], 'look_at': [0, 0, 0], 'height': )" +
          std::to_string(pixels) + R"(},
                      'materials': {'white': {'kd': null, 'type': 'lambert', 'reflectance': 0},
                                    'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}},
                      'models': {'it': {'objects': [)" +
          object.dump() + "]}}}");
}
Json moving_by(Json scene, const Vec3d& way) {
  scene["instances"] = {{{"model", "it"},
                         {"motion",
                          {{{"time", 0}, {"translate", numbers(way * -0.5)}},
                           {{"time", 1}, {"translate", numbers(way * 0.5)}}}}}};
  return scene;
}
Json square(double side) {
  return {{"type", "rectangle"},
          {"material", "lamp"},
          {"corner", {-side / 2, -side / 2, 0}},
          {"a", {side, 0, 0}},
          {"b", {0, side, 0}}};
}

// A square of side w that moves by v is blurred to a trapezoid: the fraction of the time that the square
// covers a point.
TEST(Shutter, BlursMovingSquareToTrapezoid) {
  covers("light-43");
  constexpr int kSide = 64;
  for (const auto& [w, v] : {std::pair(8.0, 20.0), std::pair(20.0, 8.0)}) {
    const Picture picture =
        render(moving_by(seen_from_above(square(w), kSide), {v, 0, 0}), open_for(1, 256, size(kSide, kSide)));
    for (int x = 0; x < kSide; ++x) {
      // Mean over the pixel by numerical integration.
      double expected = 0;
      for (int k = 0; k < 1000; ++k) {
        const double at = x - kSide / 2 + (k + 0.5) / 1000;
        const double from = std::max(-v / 2, at - w / 2), to = std::min(v / 2, at + w / 2);
        expected += std::max(0.0, to - from) / v / 1000;
      }
      double mean = 0;
      for (int y = kSide / 2 - 3; y < kSide / 2 + 3; ++y) mean += double{picture.at(x, y).x} / 6;
      EXPECT_NEAR(mean, expected, 2e-3) << w << " by " << v << " at " << x;
      if (std::abs(x + 0.5 - kSide / 2) < std::abs(v - w) / 2 - 1) {
        EXPECT_NEAR(mean, std::min(1.0, w / v), 2e-3) << "plateau at " << x;
      }
    }
  }
}

// A moving square that is out of focus has the same total radiance, and the lens adds to the blur.
TEST(Shutter, CombinesMotionAndLensBlur) {
  covers("light-43");
  Json scene = moving_by(seen_from_above(square(8), 64), {20, 0, 0});
  scene["camera"]["aperture_radius"] = 6;
  scene["camera"]["focus_distance"] = 25;
  const Picture both = render(scene, open_for(1, 256, size(64, 64)));
  double sum = 0, moment_x = 0, moment_y = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double value = double{both.at(x, y).x};
      sum += value;
      moment_x += value * (x - 31.5) * (x - 31.5);
      moment_y += value * (y - 31.5) * (y - 31.5);
    }
  EXPECT_NEAR(sum, 64, 0.2);  // the blur of radius 6 * |50 - 25| / 25 stays within the image
  const double square_and_pixel = (64.0 + 1) / 12, lens = 6.0 * 6 / 4, motion = 20.0 * 20 / 12;
  EXPECT_NEAR(moment_x / sum, square_and_pixel + lens + motion, 0.3);
  EXPECT_NEAR(moment_y / sum, square_and_pixel + lens, 0.15);
}

// A disk of diameter d that moves by D > d covers each point of its centre line for d / D of the time.
TEST(Shutter, CoversCentreLineOfMovingDiskUniformly) {
  covers("light-44");
  const Json disk = {
      {"type", "disk"}, {"material", "lamp"}, {"center", {0, 0, 0}}, {"normal", {0, 0, 1}}, {"radius", 64}};
  const Picture picture =
      render(moving_by(seen_from_above(disk, 16), {400, 0, 0}), open_for(1, 256, size(512, 16)));
  double mean = 0;
  int pixels = 0;
  for (int x = 256 - 130; x < 256 + 130; ++x)
    for (const int y : {7, 8}) mean += double{picture.at(x, y).x}, ++pixels;
  EXPECT_NEAR(mean / pixels, 128.0 / 400, 2e-4);
}

// A mesh with moving vertices gives the same image as the moving instance.
TEST(Shutter, BlursMovingMeshLikeMovingInstance) {
  covers("light-43");
  constexpr int kSide = 64;
  Json scene = seen_from_above(square(8), kSide);
  const auto corners = [](double x) {
    return Json{{x - 4, -4, 0}, {x + 4, -4, 0}, {x + 4, 4, 0}, {x - 4, 4, 0}};
  };
  // The keyframe within the exposure is on the straight path.
  scene["objects"].push_back({{"type", "mesh"},
                              {"material", "lamp"},
                              {"positions", corners(-10)},
                              {"indices", {{0, 1, 2}, {0, 2, 3}}},
                              {"motion",
                               {{{"time", 0}},
                                {{"time", 0.25}, {"positions", corners(-5)}},
                                {{"time", 1}, {"positions", corners(10)}}}}});
  const Picture mesh = render(scene, open_for(1, 64, size(kSide, kSide)));
  const Picture instance =
      render(moving_by(seen_from_above(square(8), kSide), {20, 0, 0}), open_for(1, 64, size(kSide, kSide)));
  EXPECT_LT(largest_difference(mesh, instance), 1e-5);
}

// The light of a moving lamp is the mean over time of the light from each position. A sphere of radius r and
// radiance 1 causes an irradiance of pi r^2 h / d^3 on a floor at distance h below it.
TEST(Shutter, AveragesLightOfMovingLamp) {
  covers("light-45");
  const double r = 0.5, h = 2, way = 6;
  Json scene = scene_of(
      R"([{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'white'}])",
      R"({'camera': {'type': 'orthographic', 'eye': [0, 1, 0.0], 'look_at': [0, 0, 0], 'up': [0, 0, 1], 'height': 0.1},
                            'materials': {'white': {'kd': null, 'type': 'lambert', 'reflectance': 1},
                                          'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}},
                            'models': {'it': {'objects': [{'type': 'sphere', 'center': [0, 2, 0], 'radius': 0.5, 'material': 'lamp'}]}}})");
  scene = moving_by(scene, {way, 0, 0});
  RenderRequest request = open_for(1, 1024, size(32, 32));
  request.max_depth = 1;
  const Picture picture = render(scene, request);
  double expected = 0;
  for (int k = 0; k < 10'000; ++k) {
    const double x = way * ((k + 0.5) / 10'000 - 0.5), d = std::sqrt(x * x + h * h);
    expected += r * r * h / (d * d * d) / 10'000;  // the irradiance over pi
  }
  const double mean = picture.sum() / (32 * 32);
  EXPECT_NEAR(mean / expected, 1, 0.01);
}

// A ball moves between a directional light and the floor. The shadow equals the shadow of a moving disk.
TEST(Shutter, CastsShadowsAtTimeOfRay) {
  covers("light-45");
  const Json ball = {{"type", "sphere"}, {"material", "white"}, {"center", {0, 0, 5}}, {"radius", 4}};
  Json scene = moving_by(seen_from_above(ball, 64), {20, 0, 0});
  scene["materials"]["white"] = {{"type", "lambert"}, {"reflectance", 1}};
  scene["objects"] = {
      {{"type", "plane"}, {"point", {0, 0, 0}}, {"normal", {0, 0, 1}}, {"material", "white"}}};
  scene["lights"] = {// Offset of the shadow: 5 m in the image.
                     {{"type", "directional"}, {"direction_to_light", {0, 1, 1}}}};
  for (const char* technique : {"whitted", "distributed", "path"}) {
    RenderRequest request = open_for(1, 64, size(64, 64));
    request.technique = technique;
    request.max_depth = 1;
    const Picture picture = render(scene, request);
    const double lit = double{picture.at(2, 2).x};
    // Mean along the centre line of the shadow, away from its ends. The shadow is sqrt(2) r wide in the
    // light's direction and 2 r along the motion.
    double mean = 0;
    for (int x = 30; x < 34; ++x) mean += double{picture.at(x, 32 + 5).x} / 4;
    EXPECT_NEAR(mean / lit, 1 - 8.0 / 20, 0.02) << technique;
  }
}

Json spinning() {
  return scene_of(R"([{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0]},
          {'type': 'mesh', 'crease_degrees': 60, 'positions': [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 0, 0]],
           'indices': [[4, 1, 0], [4, 2, 1], [4, 3, 2], [4, 0, 3]],
           'motion': [{'time': 1}, {'time': 3, 'positions': [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0.5, 1], [0, 1, 0.25]]}]}])",
                  R"({'camera': {'eye': [1, 3, 6], 'look_at': [0, 0, 0]},
          'lights': [{'type': 'point', 'position': [2, 5, 3]}],
          'models': {'peg': {'objects': [{'type': 'cylinder', 'base': [0, 0, 0], 'top': [0.3, 1, 0], 'radius': 0.2, 'material': 'white'}]}},
          'instances': [{'model': 'peg', 'scale': [1, 2, 1], 'rotate': {'axis': [0, 0, 1], 'degrees': 10}, 'translate': [-1.5, 0, 0],
                         'motion': [{'time': 0, 'degrees': -20}, {'time': 4, 'scale': [2, 1, 1], 'degrees': 700}]}]})");
}

// The mean of images at many instants equals one image with an open shutter.
TEST(Shutter, MatchesMeanOfInstants) {
  const auto scene = load(spinning());
  constexpr int kInstants = 64;
  std::vector<double> mean(48 * 36, 0.0);
  for (int k = 0; k < kInstants; ++k) {
    RenderRequest request = size(48, 36);
    request.samples = 16;
    request.seed = static_cast<std::uint64_t>(k);
    request.time = 1.5 + 0.5 * (k + 0.5) / kInstants;
    const Picture instant = render(scene, request);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += double{instant.pixels[i].x} / kInstants;
  }
  RenderRequest request = size(48, 36);
  request.samples = 256;
  request.time = 1.5;
  request.shutter = 0.5;
  const Picture open = render(scene, request);
  request.seed = 1;
  const Picture again = render(scene, request);
  double squares = 0, noise = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    squares += std::pow(double{open.pixels[i].x} - mean[i], 2);
    noise += std::pow(double{open.pixels[i].x - again.pixels[i].x}, 2);
  }
  EXPECT_LT(squares, 1.5 * noise);
}

TEST(Shutter, TakesSingleSampleAtMidpoint) {
  Json flat = spinning();
  flat["objects"][1].erase("crease_degrees");
  const auto scene = load(flat);
  RenderRequest open = in_double(size(48, 36)), middle = open;
  open.time = 1;
  open.shutter = 1;
  middle.time = 1.5;
  EXPECT_LT(differing_pixels(render(scene, open), render(scene, middle), 1e-6), 8);
}

TEST(Shutter, ChangesNothingWithoutMotion) {
  covers("light-42");
  const auto scene = load(spinning());
  RenderRequest instant = size(48, 36);
  instant.samples = 4;
  for (const auto& [time, seconds] : {std::pair(5.0, 1.0), std::pair(-3.0, 2.0), std::pair(2.0, 0.0)}) {
    RenderRequest open = instant;
    open.time = instant.time = time;
    open.shutter = seconds;
    EXPECT_TRUE(identical(render(scene, open), render(scene, instant))) << time;
    EXPECT_EQ(make_plan(*scene, open).shutter, 0);
  }
}

// Neither threads, slices and structures nor scaling the scene change the image.
TEST(Shutter, IsIndependentOfThreadsStructuresAndScale) {
  const Json own = spinning();
  const auto scene = load(own);
  for (const char* technique : {"whitted", "distributed", "path"}) {
    RenderRequest request = size(48, 36);
    request.samples = 4;
    request.time = 1.2;
    request.shutter = 1;
    request.technique = technique;
    request.accelerator = "list";
    const Picture expected = render(scene, request);
    EXPECT_TRUE(identical(render(scene, request, 1), expected));
    EXPECT_TRUE(identical(render(scaled(own, 0x1p-20), request), expected));
    for (const auto& type : accelerator_types()) {
      request.accelerator = type.name;
      EXPECT_TRUE(identical(render(scene, request), expected)) << type.name;
    }
    request.slice = 64;
    EXPECT_TRUE(identical(render(scene, request), expected));
    for (const Prediction prediction : {Prediction::last, Prediction::random, Prediction::network}) {
      request.prediction = prediction;
      request.reorder = true;
      EXPECT_TRUE(identical(render(scene, request), expected));
    }
  }
}

// A rotating object does not shadow itself. Under a uniform sky it is as bright as a static object.
TEST(Shutter, AvoidsSelfShadowingOfRotatingObjects) {
  Json scene = scene_of("[{'type': 'sphere', 'center': [0, -300, 0], 'radius': 1}]",
                        R"({'background': [1, 1, 1], 'camera': {'eye': [7, 5, 9], 'look_at': [7, 5, 5]},
          'materials': {'chalk': {'type': 'lambert', 'reflectance': 0.5}},
          'models': {'ball': {'objects': [{'type': 'sphere', 'center': [0.2, 0.1, 0], 'radius': 0.9, 'material': 'chalk'},
            {'type': 'box', 'min': [-2.5, -0.5, -0.5], 'max': [-1.5, 0.5, 0.5], 'material': 'chalk'}]}},
          'instances': [{'model': 'ball', 'rotate': {'axis': [1, 2, 3]}, 'translate': [7, 5, 5],
                         'motion': [{'time': 0}, {'time': 1, 'degrees': 400, 'scale': [1, 0.2, 1.5]}]}]})");
  const Picture picture = render(scene, [] {
    RenderRequest request = open_for(1, 16, size(64, 64));
    request.precision = Precision::single_precision;
    request.max_depth = 6;
    return request;
  }());
  // These two convex bodies exchange little light. Each pixel of a body has at least half the sky's radiance,
  // unless the other body occludes the sky.
  float darkest = 1;
  for (const Vec3f& pixel : picture.pixels) darkest = std::min(darkest, pixel.x);
  EXPECT_GT(darkest, 0.4f);
}

}  // namespace
}  // namespace orrery::test
