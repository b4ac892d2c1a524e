#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Compares materials in path-traced scenes with closed forms and with numerical integrals over lamps.
namespace orrery::test {
namespace {

double mean_of(const Json& scene, int side, int samples, int max_depth, int reuse = 1) {
  RenderRequest request = in_double(size(side, side));
  request.technique = "path";
  request.samples = samples;
  request.max_depth = max_depth;
  request.reuse = reuse;
  return render(scene, request).sum() / (side * side);
}

// A glass slab is between a sky of radiance 1 and a floor of reflectance rho. If the glass transmits t, the
// radiance of the floor is rho t / (1 - rho (1 - t)).
TEST(PathMaterials, MatchesFloorUnderGlassSlab) {
  covers("light-32");
  Json scene = scene_of(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'floor'},"
      " {'type': 'box', 'min': [-1e4, 1, -1e4], 'max': [1e4, 2, 1e4], 'material': 'glass'}]",
      "{'materials': {'floor': {'type': 'lambert', 'reflectance': 0.5}, 'glass': {'type': 'glass'}},"
      " 'background': [1, 1, 1]}");
  scene["camera"] = {
      {"type", "perspective"}, {"eye", {0, 0.5, 0}}, {"look_at", {0.1, 0, 0}}, {"fov_degrees", 10}};
  constexpr double kPasses = .844556;
  EXPECT_NEAR(mean_of(scene, 64, 128, 64), 0.5 * kPasses / (1 - 0.5 * (1 - kPasses)), 1e-3);
}

// A lossless ball is invisible against a uniform sky. Each scattering event has an error of at most 0.1 %.
TEST(PathMaterials, HidesGlassUnderUniformLight) {
  covers("light-30");
  for (const double roughness : {0.0, 0.4, 1.0}) {
    Json scene = scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'glass'}]",
                          "{'materials': {'white': {}}, 'background': [1, 1, 1]}");
    scene["materials"]["glass"] = {{"type", "glass"}, {"ior", 1.5}, {"roughness", roughness}};
    scene["camera"] = {
        {"type", "perspective"}, {"eye", {0, 0, 5}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 20}};
    EXPECT_NEAR(mean_of(scene, 32, 64, 64), 1, 8e-3) << roughness;
  }
}

// A disk in the shadow of a glass ball receives no light from a point light. A lamp at the same place causes
// a caustic.
TEST(PathMaterials, FocusesLampsButNotPointLightsThroughGlass) {
  covers("light-53");
  Json scene = scene_of(
      "[{'type': 'disk', 'center': [0, -1, 0], 'normal': [0, 1, 0], 'radius': 0.5},"
      " {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.7, 'material': 'glass'}]",
      "{'lights': [{'type': 'point', 'position': [0, 3, 0], 'attenuation': [0, 0, 1]}],"
      " 'materials': {'glass': {'type': 'glass'}, 'lamp': {'type': 'lambert', 'reflectance': 0}}}");
  const Vec3d from(3, -0.5, 0), below(0, -1, 0);
  EXPECT_EQ(estimate_alone(scene, from, below, 6, 16).mean, 0);
  constexpr double kRadius = 0.3;
  scene["lights"] = Json::array();
  // Same intensity as the point light.
  scene["materials"]["lamp"]["emission"] = Json(3, 1 / (kRadius * kRadius));
  scene["objects"].push_back(
      {{"type", "sphere"}, {"center", {0, 3, 0}}, {"radius", kRadius}, {"material", "lamp"}});
  const Estimate found = estimate_alone(scene, from, below, 6, 64);
  EXPECT_GT(found.mean, 2.0 / 16) << "twice the radiance due to the lamp without the ball";
  EXPECT_LT(found.error(), 0.05 * found.mean);
}

struct Lit {
  const char* name;
  const char* text;
  double lamp_height;  // negative if light is transmitted
};
class LampIllumination : public testing::TestWithParam<Lit> {};

// Compares the radiance at a point below a square lamp with the integral of the evaluated material over the
// lamp. Both MIS and BSDF sampling alone must agree with the integral.
TEST_P(LampIllumination, MatchesIntegralOverLamp) {
  covers("light-22");
  const auto& [name, text, height] = GetParam();
  const Vec3d eye = safe_normalize(Vec3d(0.8, 0.9, 0.1));
  const Probe<double> material(text);
  constexpr int kSteps = 300;
  constexpr double kSide = 2, kAside = -0.8;  // the lamp is in the mirror direction
  std::vector<Probe<double>::Case> cases;
  std::vector<double> angle;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec3d to(kAside + kSide * ((i + 0.5) / kSteps - 0.5), height, kSide * ((j + 0.5) / kSteps - 0.5));
      Probe<double>::Case c;
      c.direction = -eye;
      c.normal = c.geometric = Vec3d(0, 1, 0);
      c.light = safe_normalize(to);
      cases.push_back(c);
      const double distance2 = dot(to, to);
      angle.push_back(kSide * kSide / (kSteps * kSteps) * std::abs(height) /
                      (distance2 * std::sqrt(distance2)));
    }
  double sum = 0;
  const auto found = material.evaluated(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) sum += found[i].pi_bsdf_cos.x * angle[i] / std::numbers::pi;

  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'it'}]",
                        "{'materials': {'white': {}, 'lamp': {'type': 'lambert', 'reflectance': 0, "
                        "'emission': [1, 1, 1]}}}");
  scene["materials"]["it"] = json(text);
  scene["objects"].push_back({{"type", "rectangle"},
                              {"corner", {kAside - kSide / 2, height, -kSide / 2}},
                              {"a", {kSide, 0, 0}},
                              {"b", {0, 0, kSide}},
                              {"material", "lamp"}});
  scene["camera"] = {{"type", "perspective"},
                     {"eye", {eye.x * 0.9, eye.y * 0.9, eye.z * 0.9}},
                     {"look_at", {0, 0, 0}},
                     {"fov_degrees", 1e-4}};
  EXPECT_NEAR(mean_of(scene, 32, 256, 1) / sum, 1, 0.01) << name;
  // The lamp is instanced.
  Json model = scene;
  model["models"]["lamp"]["objects"] = Json::array({scene["objects"].back()});
  model["objects"].erase(model["objects"].size() - 1);
  model["instances"] = json("[{'model': 'lamp'}]");
  EXPECT_NEAR(mean_of(model, 32, 256, 1) / sum, 1, 0.01) << name;
  // Lights with keyframes inside a model are not sampled, so only BSDF sampling finds them.
  const double x0 = kAside - kSide / 2, x1 = kAside + kSide / 2, z = kSide / 2;
  model["models"]["lamp"]["objects"] =
      Json::array({{{"type", "mesh"},
                    {"positions", {{x0, height, -z}, {x1, height, -z}, {x1, height, z}, {x0, height, z}}},
                    {"indices", {{0, 1, 2}, {0, 2, 3}}},
                    {"motion", {{{"time", 0}}, {{"time", 1}}}},
                    {"material", "lamp"}}});
  EXPECT_NEAR(mean_of(model, 32, 256, 1) / sum, 1, 0.02) << name;
}
INSTANTIATE_TEST_SUITE_P(
    Materials, LampIllumination,
    testing::Values(
        Lit{"GlassThrough", "{'type': 'glass', 'roughness': 0.6}", -1},
        Lit{"GlassAbove", "{'type': 'glass', 'roughness': 0.6}", 1},
        Lit{"Plastic", "{'type': 'plastic', 'roughness': 0.4}", 1},
        Lit{"Coated", "{'type': 'coated', 'coat': 1, 'coat_roughness': 0.4, 'sheen_color': 0.5}", 1},
        Lit{"MetallicRoughness", "{'type': 'metallic-roughness', 'metallic': 0.5, 'roughness': 0.5}", 1},
        Lit{"CookTorrance", "{'type': 'cook-torrance', 'diffuse': 0.3, 'specular': 0.7}", 1},
        Lit{"TranslucentThrough", "{'type': 'translucent'}", -1},
        Lit{"TranslucentAbove", "{'type': 'translucent'}", 1}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

// Returns the radiance of a white floor at the origin, lit with radiance 1 from directions d where sees(d) is
// true.
template <class Sees>
double lit_by(const Sees& sees) {
  constexpr int kSteps = 1000;  // steps in height and azimuth, with equal cosine-weighted cells
  double found = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double sine2 = (i + 0.5) / kSteps, turn = 2 * std::numbers::pi * (j + 0.5) / kSteps;
      const double sine = std::sqrt(sine2), up = std::sqrt(1 - sine2);
      found += sees(Vec3d(sine * std::cos(turn), up, sine * std::sin(turn)));
    }
  return found / kSteps / kSteps;
}

// Instances transform a ball into an ellipsoid and a square into a parallelogram. The floor must be lit as by
// the transformed shapes.
TEST(PathMaterials, TransformsLampsByInstances) {
  const Vec3d centre(0.3, 1, 0), radii(0.8, 0.2, 0.4);
  const double ellipsoid = lit_by([&](const Vec3d& d) {
    const Vec3d from(centre.x / radii.x, centre.y / radii.y, centre.z / radii.z);
    const Vec3d toward = safe_normalize(Vec3d(d.x / radii.x, d.y / radii.y, d.z / radii.z));
    return length(cross(from, toward)) < 1;
  });
  // Parallelogram at (-1, 1, 0) with sides (1, 0, 0.3) and (1, 0, -0.3).
  const double skew = lit_by([](const Vec3d& d) {
    const double sum = d.x / d.y + 1, difference = d.z / d.y / 0.3;
    return std::abs(difference) < std::min(sum, 2 - sum);
  });
  const auto lit = [](const char* object, const char* instance) {
    Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'floor'}]",
                          "{'materials': {'white': {}, 'floor': {'type': 'lambert', 'reflectance': 1},"
                          "'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}}}");
    scene["models"]["lamp"]["objects"] = Json::array({json(object)});
    scene["instances"] = Json::array({json(instance)});
    scene["camera"] = {
        {"type", "perspective"}, {"eye", {0, 0.2, 0.3}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 1e-3}};
    return mean_of(scene, 32, 256, 1);
  };
  EXPECT_NEAR(lit("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.4, 'material': 'lamp'}",
                  "{'model': 'lamp', 'scale': [2, 0.5, 1], 'translate': [0.3, 1, 0]}") /
                  ellipsoid,
              1, 0.01);
  EXPECT_NEAR(lit("{'type': 'rectangle', 'corner': [0, 0, 0], 'edge_u': [1, 0, 1], 'edge_v': [1, 0, -1], "
                  "'material': 'lamp'}",
                  "{'model': 'lamp', 'scale': [1, 1, 0.3], 'translate': [-1, 1, 0]}") /
                  skew,
              1, 0.01);
}

// Stripes of chalk and of dark polished plastic are below a ceiling lit by a spot light. Samples of the coat
// are mirrored, and samples of the chalk never are. Path reuse must weight a shared sample by the densities
// of all lobes, not only by the density of the lobe that generated the sample. The plastic is too dark to
// offset excess light on the chalk.
TEST(PathMaterials, WeightsSharedSamplesThroughMirrors) {
  covers("light-9");
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 2, 0], 'normal': [0, -1, 0], 'material': 'chalk'}]",
                        "{'materials': {'chalk': {'type': 'lambert', 'reflectance': 0.8},"
                        "'coat': {'type': 'plastic', 'reflectance': 0.1, 'roughness': 0}},"
                        "'lights': [{'type': 'spot', 'position': [0, 1, 0], 'direction': [0, 1, 0], "
                        "'inner_degrees': 50, 'outer_degrees': 60}]}");
  for (int stripe = -20; stripe < 20; ++stripe)
    scene["objects"].push_back({{"type", "rectangle"},
                                {"corner", {0.1 * stripe, 0, -2}},
                                {"a", {0.1, 0, 0}},
                                {"b", {0, 0, 4}},
                                {"material", stripe % 2 == 0 ? "coat" : "chalk"}});
  scene["camera"] = {
      {"type", "perspective"}, {"eye", {0, 0.9, 1.5}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 40}};
  EXPECT_NEAR(mean_of(scene, 64, 256, 2, 16) / mean_of(scene, 64, 256, 2, 1), 1, 0.006);
}

}  // namespace
}  // namespace orrery::test
