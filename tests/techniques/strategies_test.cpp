#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/lighting/light_tree.h"
#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/tracing.h"

// Compares estimates of the same radiance by light sampling, BSDF sampling, and both with MIS.
namespace orrery::test {
namespace {

const Vec3d kUp(0, 1, 0);
const Vec3d kViewer = safe_normalize(Vec3d(0.8, 0.9, 0.1));  // from the surface at the origin

struct Named {
  const char* name;
  const char* text;
};
// Lamps around the mirror direction of the viewer.
const std::vector<Named> kLamps = {
    {"Rectangle",
     "{'type': 'rectangle', 'corner': [-2, 1.5, -0.8], 'edge_u': [1.5, 0, 0], 'edge_v': [0, 0.3, 1.6]}"},
    {"Ball", "{'type': 'sphere', 'center': [-1.2, 1.6, 0.3], 'radius': 0.7}"},
    {"Disk", "{'type': 'disk', 'center': [-1, 1.4, 0.2], 'normal': [0.2, -1, 0.1], 'radius': 0.8}"},
    {"Triangle", "{'type': 'triangle', 'vertices': [[-2, 1.2, -1], [0.5, 1.5, -0.5], [-0.8, 1.9, 1.2]]}"},
    {"Mesh",
     "{'type': 'mesh', 'positions': [[-2, 1.2, -1], [0.5, 1.5, -0.5], [-0.8, 1.9, 1.2], [-2.5, 1.3, 0.8]],"
     " 'indices': [[0, 1, 2], [0, 3, 2]]}"},
    {"Sun", "{'type': 'directional', 'direction_to_light': [-0.8, 1, 0.1], 'angle_degrees': 40}"},
    {"Box", "{'type': 'box', 'min': [-1.6, 1, -0.5], 'max': [-0.6, 1.6, 0.7]}"},
    {"LowBox", "{'type': 'box', 'min': [-2, 0.1, -0.8], 'max': [-0.4, 2, 1]}"},
    {"Column", "{'type': 'cylinder', 'base': [-1, 0.9, -0.8], 'top': [-1.4, 1.6, 0.9], 'radius': 0.3}"},
    {"Tube", "{'type': 'cylinder', 'base': [-1, 1, -3], 'top': [-1.4, 1.6, 3], 'radius': 0.1}"},
    {"Drum", "{'type': 'cylinder', 'base': [-1.2, 1.2, 0.1], 'top': [-1.2, 1.5, 0.3], 'radius': 0.8}"},
    // Instanced lamps.
    {"PlacedBox",
     "{'type': 'box', 'min': [-0.5, -0.5, -0.5], 'max': [0.5, 0.5, 0.5], 'instance': "
     "{'scale': [2, 0.5, 1], 'rotate': {'axis': [0.2, 0, 1], 'degrees': 25}, 'translate': [-1.2, 1.6, "
     "0.1]}}"},
    {"PlacedColumn",
     "{'type': 'cylinder', 'base': [0, 0, 0], 'top': [0, 1, 0], 'radius': 0.5, 'instance': "
     "{'scale': [0.6, 2, 0.6], 'rotate': {'axis': [1, 0, 0.3], 'degrees': 60}, 'translate': [-1, 0.9, -1]}}"},
    {"PlacedRectangle",
     "{'type': 'rectangle', 'corner': [-0.5, 0, -0.5], 'edge_u': [1, 0, 0], 'edge_v': [0, 0, 1], 'instance': "
     "{'scale': [1.5, 9, 2], 'rotate': {'axis': [0.1, 0, 1], 'degrees': 20}, 'translate': [-1.2, 1.6, 0]}}"},
    {"PlacedBall",
     "{'type': 'sphere', 'center': [0.1, 0, 0], 'radius': 0.35, 'instance': "
     "{'scale': [2, 2, 2], 'rotate': {'axis': [0, 1, 0], 'degrees': 70}, 'translate': [-1.2, 1.6, 0.3]}}"},
    {"PlacedDisk",
     "{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 1, 0], 'radius': 0.5, 'instance': "
     "{'scale': [2, 1, 1.2], 'rotate': {'axis': [0, 0, 1], 'degrees': -20}, 'translate': [-1, 1.4, 0.2]}}"},
    {"PlacedTriangle",
     "{'type': 'triangle', 'vertices': [[-1, 0, -1], [1, 0, -0.5], [0, 0.5, 1]], 'instance': "
     "{'scale': [1.5, 0.5, -1], 'rotate': {'axis': [1, 1, 1], 'degrees': 15}, 'translate': [-1, 1.5, 0]}}"}};
const std::vector<Named> kMaterials = {
    {"Lambert", "{'type': 'lambert', 'reflectance': 0.8}"},
    {"OrenNayar", "{'type': 'oren-nayar', 'reflectance': 0.8, 'roughness': 0.7}"},
    {"Metal", "{'type': 'metal', 'name': 'copper', 'roughness': 0.4}"},
    {"RoughMetal", "{'type': 'metal', 'name': 'gold', 'roughness': 0.8}"},
    {"Plastic", "{'type': 'plastic', 'reflectance': 0.4, 'roughness': 0.4}"},
    {"MetallicRoughness", "{'type': 'metallic-roughness', 'metallic': 0.5, 'roughness': 0.6}"},
    {"Coated", "{'type': 'coated', 'roughness': 0.6, 'coat': 1, 'coat_roughness': 0.5, 'sheen_color': 0.5}"},
    {"CookTorrance", "{'type': 'cook-torrance', 'diffuse': 0.3, 'specular': 0.7}"},
    {"Glass", "{'type': 'glass', 'roughness': 0.6}"},
    {"Rough", "{'type': 'rough', 'kd': 0.5, 'ks': 0.4, 'shininess': 20}"}};

bool is_light(const Json& lamp) { return lamp["type"] == "directional"; }

// Returns a scene of the lamp alone, or over a small surface at the origin if `material` is given. Every
// scene needs an object.
Json scene_of_lamp(const Json& lamp, const Json* material) {
  Json scene = scene_of("[{'type': 'sphere', 'center': [0, -90, 0], 'radius': 1, 'material': 'black'}]",
                        "{'materials': {'white': {}, 'black': {'type': 'lambert', 'reflectance': 0},"
                        "'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}}}");
  if (is_light(lamp)) {
    scene["lights"] = Json::array({lamp});
  } else {
    Json object = lamp, instance = object.value("instance", Json());
    object.erase("instance");
    object["material"] = "lamp";
    if (instance.is_null()) {
      scene["objects"].push_back(object);
    } else {
      instance["model"] = "lamp";
      scene["models"]["lamp"]["objects"] = Json::array({object});
      scene["instances"] = Json::array({instance});
    }
  }
  if (!material) return scene;
  scene["materials"]["it"] = *material;
  scene["objects"].push_back(
      json("{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 1, 0], 'radius': 1e-3, 'material': 'it'}"));
  return scene;
}

// Returns mean and standard deviation over the elements of a batch.
Estimate of_slots(const std::vector<double>& slots) {
  double sum = 0, squares = 0;
  for (const double slot : slots) {
    sum += slot / kBatch;
    squares += slot * slot / kBatch;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}

Probe<double>::Case view(const Vec3d& light) {
  Probe<double>::Case one;
  one.direction = -kViewer;
  one.normal = one.geometric = kUp;
  one.light = light;
  return one;
}

// Estimates by light sampling alone. Each part of the lamp has the same probability.
Estimate by_light(const Json& lamp, const Probe<double>& material, int samples) {
  const Tracing lit(scene_of_lamp(lamp, nullptr));
  const Geometry<double>& geometry = *lit.world().geometry;
  const LightKernel<double>* kernel = geometry.emitters.get();
  for (const auto& lights : geometry.lights)
    if (lights) kernel = lights.get();
  const int parts = static_cast<int>(geometry.light_tree->size());
  const auto surface = std::make_unique<SurfaceBatch<double>>();
  const auto choices = std::make_unique<LightChoices<double>>();
  const auto out = std::make_unique<LightBatch<double>>();
  Array<IndexOf<double>> slot{};
  for (int i = 0; i < kBatchRoom; ++i) {
    slot[i] = i % kBatch;
    surface->normal.set(i, kUp);
    surface->geometric.set(i, kUp);
    choices->probability[i] = 1.0 / parts;
  }
  std::vector<double> slots(kBatch);
  for (int sample = 0; sample < samples; ++sample) {
    for (int i = 0; i < kBatchRoom; ++i) choices->index[i] = (i + sample) % parts;
    const Draws draws(3, TileView{0, 0, kTileSide, kTileSide}, sample);
    kernel->sample_each(*surface, *choices, PathDraws<double>{draws, slot, 0},
                        LaneGroups::covering(0, kBatch, kWidth<double>), *out);
    std::vector<Probe<double>::Case> cases;
    for (int i = 0; i < kBatch; ++i) cases.push_back(view(out->shadow.direction[i]));
    const auto found = material.evaluated(cases);
    for (int i = 0; i < kBatch; ++i)
      if (out->shadow.t_max[i] > 0)
        slots[static_cast<std::size_t>(i)] +=
            found[static_cast<std::size_t>(i)].pi_bsdf_cos.x * out->incident[i].x / samples;
  }
  return of_slots(slots);
}

// Estimates by BSDF sampling alone.
Estimate by_lobe(const Json& lamp, const Probe<double>& material, int samples) {
  RenderRequest request;
  request.technique = "path";
  request.max_depth = 0;
  Tracing lit(scene_of_lamp(lamp, nullptr), request);
  std::vector<double> slots(kBatch);
  for (int sample = 0; sample < samples; ++sample) {
    const auto drawn = material.sampled(view(kUp), kBatch, static_cast<std::uint64_t>(sample) + 1);
    std::vector<Ray<double>> rays;
    for (const auto& one : drawn) rays.push_back({Vec3d(), one.weight.x > 0 ? one.direction : -kUp});
    const std::vector<TraceOutput> seen = lit.trace(rays);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      slots[i] += (drawn[i].weight.x > 0 ? drawn[i].weight.x * seen[i].radiance.x : 0) / samples;
  }
  return of_slots(slots);
}

Estimate by_both(const Json& lamp, const Json& material, int samples) {
  return estimate_alone(scene_of_lamp(lamp, &material), kViewer * 0.1, Vec3d(), 1, samples);
}

class SamplingStrategies : public testing::TestWithParam<Named> {};

// All three estimates agree. MIS has at most the deviation of the better strategy, unless light sampling
// alone has almost no noise. In that case, BSDF samples raise the deviation by up to a quarter.
TEST_P(SamplingStrategies, AgreeForEveryMaterial) {
  covers("light-22");
  const Json lamp = json(GetParam().text);
  for (const auto& [name, text] : kMaterials) {
    const Json material = json(text);
    const Probe<double> probe(material);
    const auto estimates = [&](int samples) {
      return std::array{by_light(lamp, probe, samples), by_lobe(lamp, probe, samples),
                        by_both(lamp, material, samples)};
    };
    const auto means = estimates(16);  // stratified
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_NEAR(means[a].mean, means[b].mean, 4 * std::hypot(means[a].error(), means[b].error()))
            << name << " " << a << b;
    const auto [light, lobe, both] = estimates(1);
    EXPECT_LE(both.sd, 1.25 * std::min(light.sd, lobe.sd)) << name;
  }
}
INSTANTIATE_TEST_SUITE_P(Lamps, SamplingStrategies, testing::ValuesIn(kLamps),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace orrery::test
