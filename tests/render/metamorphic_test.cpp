#include <gtest/gtest.h>

#include "core/accelerators/registry.h"
#include "core/model/technique.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Tests changes of scene or request that must not affect the image, with every scene of scenes/ and with
// random scenes.
namespace orrery::test {
namespace {

// Returns a request for a small image. The image is smaller if tests are reduced.
RenderRequest small(int samples = 1) {
  RenderRequest request = reduced() ? size(64, 48) : size(160, 120);
  request.samples = samples;
  return request;
}

class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  const std::shared_ptr<const Scene> scene_ = load(sample(GetParam()));
};

TEST_P(EveryScene, HasOnlyFiniteValues) {
  covers("A36 B3");
  for (const RenderRequest& request : {in_float(small(4)), in_double(small())}) {
    const Picture picture = render(scene_, request);
    EXPECT_EQ(picture.stats.non_finite_pixels, 0u);
    for (const Vec3f& pixel : picture.pixels) EXPECT_TRUE(pixel.x >= 0 && pixel.y >= 0 && pixel.z >= 0);
  }
}

TEST_P(EveryScene, IsIndependentOfThreadsAndSlices) {
  covers("E21");
  const Picture expected = render(scene_, small(2), 1);
  EXPECT_TRUE(identical(expected, render(scene_, small(2), 2)));
  EXPECT_TRUE(identical(expected, render(scene_, small(2), 8)));
  for (const int slice : {16, 64, 256, 1024}) {
    RenderRequest request = small(2);
    request.slice = slice;
    EXPECT_TRUE(identical(expected, render(scene_, request))) << "slice " << slice;
  }
}

TEST_P(EveryScene, MatchesFullModel) {
  for (RenderRequest request : {in_float(small()), in_double(small())}) {
    const Picture planned = render(scene_, request);
    request.full_model = true;
    EXPECT_TRUE(identical(planned, render(scene_, request)));
  }
}

TEST_P(EveryScene, IsIndependentOfAccelerator) {
  covers("F1");
  for (RenderRequest request : {in_float(small()), in_double(small())}) {
    request.accelerator = "list";
    const Picture reference = render(scene_, request);
    for (const auto& type : accelerator_types()) {
      request.accelerator = type.name;
      EXPECT_TRUE(identical(reference, render(scene_, request))) << type.name;
    }
  }
}

TEST_P(EveryScene, IsIndependentOfRayOrder) {
  covers("F17");
  for (RenderRequest request : {in_float(small()), in_double(small())}) {
    const Picture reference = render(scene_, request);
    request.reorder = true;
    for (const auto& type : accelerator_types()) {
      request.accelerator = type.name;
      EXPECT_TRUE(identical(reference, render(scene_, request))) << type.name;
    }
  }
}

TEST_P(EveryScene, IsIndependentOfShadowPrediction) {
  covers("F18");
  for (RenderRequest request : {in_float(small()), in_double(small())}) {
    const Picture reference = render(scene_, request);
    EXPECT_EQ(reference.stats.counts.accelerator.predicted_occluders, 0u);
    for (const bool reorder : {false, true})
      for (const Prediction prediction : {Prediction::network, Prediction::last, Prediction::random}) {
        request.reorder = reorder;
        request.prediction = prediction;
        EXPECT_TRUE(identical(reference, render(scene_, request))) << name_of(prediction);
      }
  }
}

// Lengths are scaled by 2^17 and 2^-17 at equal irradiance, so the renderer may contain no absolute length.
TEST_P(EveryScene, IsScaleInvariant) {
  covers("A19");
  const Json scene = without_filters(sample(GetParam()));
  for (const RenderRequest& request : {in_float(small()), in_double(small())}) {
    const Picture expected = render(scene, request);
    for (const double factor : {0x1p17, 0x1p-17})
      EXPECT_TRUE(identical(expected, render(scaled(scene, factor), request))) << factor;
  }
  const Picture planned = render(scene, small());
  EXPECT_TRUE(identical(planned, render(scaled(scene, 0x1p17), small()))) << "the plan depends on the scale";
  EXPECT_TRUE(identical(planned, render(scaled(scene, 0x1p-17), small()))) << "the plan depends on the scale";
}

// Float and double may differ at an edge, and curved mirrors multiply edges. In most scenes no pixel differs
// by more than 1/512. With 820 mirrored balls, 40 of 19,200 pixels differ by more.
TEST_P(EveryScene, AgreesInFloatAndDouble) {
  const Picture single = render(scene_, in_float(small())), exact = render(scene_, in_double(small()));
  EXPECT_LE(differing_pixels(single, exact, 1.0 / 512), 160 * 120 / 200);
  double off = 0;
  for (float Vec3f::*channel : {&Vec3f::x, &Vec3f::y, &Vec3f::z})
    off = std::max(off, std::abs(single.sum(channel) - exact.sum(channel)));
  EXPECT_LE(off / (160 * 120), 1.0 / 512) << "mean of the image";
}

// Ray casting equals Whitted's technique at depth 0.
TEST_P(EveryScene, MatchesRaycastAtDepthZero) {
  RenderRequest cast = small(), traced = small();
  cast.technique = "raycast";
  traced.technique = "whitted";
  traced.max_depth = 0;
  EXPECT_TRUE(identical(render(scene_, cast), render(scene_, traced)));
}

TEST_P(EveryScene, CountsPlausibleRays) {
  const RenderRequest request = small(3);
  const Picture picture = render(scene_, request);
  const RayCounts& rays = picture.stats.counts.rays;
  if (make_plan(*scene_, request).technique->draws_light) return;  // more rays per sample
  EXPECT_EQ(rays.camera, static_cast<std::uint64_t>(*request.width * *request.height * 3));
  EXPECT_EQ(rays.reflected[0] + rays.refracted[0], 0u);
  const auto lights = scene_->lights.size();
  std::uint64_t from_here = rays.camera;
  for (std::size_t depth = 0; depth + 1 < rays.shadow.size(); ++depth) {
    EXPECT_LE(rays.shadow[depth], from_here * lights) << depth;
    EXPECT_LE(rays.reflected[depth + 1] + rays.refracted[depth + 1], 2 * from_here) << depth;
    from_here = rays.reflected[depth + 1] + rays.refracted[depth + 1];
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(sample_names()), parameter_name);

// Returns a scene of random shapes, materials and lights. The eye may be inside a shape.
Json random_scene(std::uint64_t seed) {
  Random random(seed);
  const auto color = [&] { return numbers(Vec3d(random.unit(), random.unit(), random.unit())); };
  Json materials;
  materials["a"] = {
      {"type", "rough"}, {"kd", color()}, {"ks", random.unit()}, {"shininess", random.magnitude(1, 200)}};
  materials["b"] = {{"type", "rough"}, {"kd", color()}, {"shading", "phong"}, {"ks", color()}};
  materials["c"] = {{"type", "reflective"},
                    {"n", color()},
                    {"k", {3 * random.unit(), 2, 1}},
                    {"fresnel", random.below(2) ? "exact" : "schlick"}};
  materials["d"] = {{"type", "refractive"},
                    {"ior", random.between(0.6, 2.5)},
                    {"fresnel", random.below(2) ? "exact" : "schlick"}};
  if (random.below(2)) materials["d"]["filter"] = color();
  const int kinds = random.below(15) + 1;  // bit i is set if material i is used
  std::vector<std::string> used;
  for (int i = 0; i < 4; ++i)
    if (kinds >> i & 1) used.push_back(std::string(1, static_cast<char>('a' + i)));
  Json objects = Json::array(), lights = Json::array();
  const std::vector<std::string> types = shape_names();
  for (int i = random.below(3) ? random.below(10) + 1 : 1; i > 0; --i) {
    const auto& samples =
        shape_samples(types[static_cast<std::size_t>(random.below(static_cast<int>(types.size())))]);
    Json object = placed(samples[static_cast<std::size_t>(random.below(static_cast<int>(samples.size())))],
                         random.magnitude(.1, 2), random.in_cube(2));
    object["material"] = used[static_cast<std::size_t>(random.below(static_cast<int>(used.size())))];
    objects.push_back(object);
  }
  for (int i = random.below(4); i > 0; --i) {
    if (i == 1)
      lights.push_back({{"type", "directional"},
                        {"direction_to_light", numbers(random.direction())},
                        {"intensity", color()}});
    if (i == 2)
      lights.push_back(
          {{"type", "point"}, {"position", numbers(random.in_cube(4))}, {"attenuation", {.5, .1, .1}}});
    if (i == 3)
      lights.push_back({{"type", "spot"},
                        {"position", numbers(random.in_cube(4))},
                        {"direction", numbers(random.direction())}});
  }
  Json scene{{"version", 1},     {"materials", materials}, {"objects", objects},
             {"lights", lights}, {"ambient", color()},     {"background", color()}};
  scene["camera"] = {{"type", random.below(4) ? "perspective" : "orthographic"},
                     {"eye", numbers(random.in_cube(4))},
                     {"look_at", numbers(random.in_cube(1))}};
  if (scene["camera"]["type"] == "orthographic") scene["camera"]["height"] = 5;
  return scene;
}

TEST(RandomScenes, MatchesFullModelWithEveryAccelerator) {
  covers("A36 F1");
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto scene = load(random_scene(seed));
    for (RenderRequest request : {in_float(size(48, 32)), in_double(size(48, 32))}) {
      request.max_depth = 6;
      const Picture planned = render(scene, request);
      EXPECT_EQ(planned.stats.non_finite_pixels, 0u) << seed;
      request.full_model = true;
      for (const auto& type : accelerator_types()) {
        request.accelerator = type.name;
        EXPECT_TRUE(identical(planned, render(scene, request))) << "scene " << seed << " with " << type.name;
      }
    }
  }
}

TEST(RandomScenes, IsScaleInvariant) {
  covers("A19");
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Json scene = without_filters(random_scene(seed));
    const Picture expected = render(scene, size(48, 32));
    for (const double factor : {0x1p17, 0x1p-17})
      EXPECT_TRUE(identical(expected, render(scaled(scene, factor), size(48, 32)))) << seed;
  }
}

}  // namespace
}  // namespace orrery::test
