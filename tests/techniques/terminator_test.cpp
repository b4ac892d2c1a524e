#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests smooth meshes where light grazes their triangles. The reference of a smooth ball is the sphere.
namespace orrery::test {
namespace {

constexpr int kSide = 96;

Json ball(int sectors, int rings) {
  constexpr double kPi = std::numbers::pi;
  Json mesh = json("{'type': 'mesh', 'material': 'it', 'positions': [], 'normals': [], 'indices': []}");
  for (int ring = 0; ring <= rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const double theta = kPi * ring / rings, phi = 2 * kPi * sector / sectors;
      const Json at = {std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)};
      mesh["positions"].push_back(at);
      mesh["normals"].push_back(at);
      if (ring == rings) continue;
      const int here = ring * sectors + sector, next = ring * sectors + (sector + 1) % sectors;
      if (ring > 0) mesh["indices"].push_back({here, here + sectors, next});
      if (ring + 1 < rings) mesh["indices"].push_back({next, here + sectors, next + sectors});
    }
  return mesh;
}

// Returns a cube with corners at `lo` and `hi`. With `smooth`, its 8 vertices have the mean normals of their
// faces, otherwise each face has the normal of its plane.
Json cube(const Vec3d& lo, const Vec3d& hi, bool smooth, bool with_normals = true) {
  Json mesh = json("{'type': 'mesh', 'material': 'it', 'positions': [], 'indices': []}");
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int first = static_cast<int>(mesh["positions"].size());
      for (int corner = 0; corner < 4; ++corner) {
        Vec3d at, normal(0, 0, 0);
        const int upper[3] = {side, corner % 2, corner / 2};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t along = (static_cast<std::size_t>(axis) + k) % 3;
          at[along] = upper[k] == 1 ? hi[along] : lo[along];
          if (smooth || k == 0) normal[along] = upper[k] == 1 ? 1 : -1;
        }
        mesh["positions"].push_back(numbers(at));
        if (with_normals) mesh["normals"].push_back(numbers(normal));
      }
      const bool turned = side == 0;
      mesh["indices"].push_back({first, first + (turned ? 2 : 1), first + (turned ? 1 : 2)});
      mesh["indices"].push_back({first + 3, first + (turned ? 1 : 2), first + (turned ? 2 : 1)});
    }
  return mesh;
}

const Json kRough = json("{'type': 'rough', 'kd': 1, 'ka': 0}");

Json lit(const Json& objects, const Json& light, const Json& material = kRough) {
  return scene_with(objects, {{"camera", {{"eye", {0, 0, 5}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 35}}},
                              {"materials", {{"it", material}}},
                              {"ambient", {0, 0, 0}},
                              {"background", {7, 7, 7}},
                              {"lights", {light}}});
}

// Renders a scene. Without `smooth`, shading follows the planes of triangles at the terminator.
Picture seen(const Json& json, bool smooth, RenderRequest request = {}) {
  if (!request.width) request.width = request.height = kSide;
  const auto scene = load(json);
  const PreparedScene prepared(scene);
  Plan plan = make_plan(*scene, request);
  plan.fields.smooth = plan.fields.smooth && smooth;
  const RenderResult result =
      render_frame(prepared, settle(prepared, plan), FilmStorage::sums, shared_executor());
  Picture picture{plan.width, plan.height, {}, result.stats};
  for (std::size_t i = 0; const double value : linear_values(result.film)) {
    if (i % 3 == 0) picture.pixels.emplace_back();
    picture.pixels.back()[i++ % 3] = static_cast<float>(value);
  }
  return picture;
}

constexpr float kBackground = 6;  // radiance above that of all lit surfaces

// Returns the root mean square difference over pixels that show an object in both images. With `band`, takes
// only pixels around the terminator in `b`, away from the silhouette of a ball in the middle. Positions on
// the silhouettes of a mesh and of a sphere differ.
double rms_on_objects(const Picture& a, const Picture& b, bool band = false) {
  constexpr double kRadius = 0.31, kShare = 0.75;  // radius of the ball / image width; part of the disc
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double one = a.at(x, y).x, other = b.at(x, y).x;
      if (one > kBackground || other > kBackground) continue;
      const double off = std::hypot(x + 0.5 - a.width * 0.5, y + 0.5 - a.height * 0.5) / a.width;
      if (band && (off > kShare * kRadius || other > 0.25)) continue;
      sum += (one - other) * (one - other);
      ++count;
    }
  return std::sqrt(sum / count);
}

struct Light {
  const char* name;
  const char* json;
};
class TerminatorOf : public testing::TestWithParam<Light> {};

TEST_P(TerminatorOf, LowPolyBallMatchesSphere) {
  covers("C11");
  const Json light = json(GetParam().json),
             sphere = json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}");
  for (const char* material : {"{'type': 'rough', 'kd': 1, 'ka': 0}", "{'type': 'lambert', 'reflectance': 1}",
                               "{'type': 'plastic', 'roughness': 0.5}"})
    for (const RenderRequest& request : {in_double(), in_float()}) {
      const Json it = json(material);
      const Picture right = seen(lit(sphere, light, it), true, request);
      const double before = rms_on_objects(seen(lit(ball(16, 8), light, it), false, request), right, true),
                   after = rms_on_objects(seen(lit(ball(16, 8), light, it), true, request), right, true);
      EXPECT_LE(after, 0.01) << material;
      EXPECT_LE(after, before / 3) << material;
    }
}
INSTANTIATE_TEST_SUITE_P(
    Lights, TerminatorOf,
    testing::Values(Light{"directional", "{'type': 'directional', 'direction_to_light': [1, 0.2, 0.1]}"},
                    Light{"point", "{'type': 'point', 'position': [30, 6, 3], 'attenuation': [1, 0, 0]}"}),
    [](const auto& test) { return std::string(test.param.name); });

const Json kSun = json("{'type': 'directional', 'direction_to_light': [1, 0.2, 0.1]}");

// Light is added only where no light of the source was reflected before. It is at most the sine of the angle
// between the interpolated normal and the plane.
TEST(Terminator, ChangesOnlyUnlitPoints) {
  const Picture before = seen(lit(ball(16, 8), kSun), false), after = seen(lit(ball(16, 8), kSun), true);
  const double most = std::sin(std::numbers::pi / 16 * std::sqrt(2.0));
  int changed = 0;
  for (std::size_t i = 0; i < before.pixels.size(); ++i) {
    if (before.pixels[i] == after.pixels[i]) continue;
    ++changed;
    EXPECT_EQ(before.pixels[i].x, 0);
    EXPECT_LE(after.pixels[i].x, most);
  }
  EXPECT_GT(changed, 100);
}

// Meshes without vertex normals cost nothing. Vertex normals that equal those of the planes change no bit.
TEST(Terminator, FlatMeshesKeepTheirBits) {
  const Vec3d lo(-1, -1, -1), hi(1, 0.7, 0.9);
  const Json turn =
      json("{'camera': {'eye': [3, 2.5, 4]}, 'lights': [{'type': 'point', 'position': [3, 0.7001, 2]}]}");
  Json plain = lit(cube(lo, hi, false, false), kSun), flat = lit(cube(lo, hi, false), kSun);
  for (Json* scene : {&plain, &flat}) scene->merge_patch(turn);
  EXPECT_FALSE(make_plan(*load(plain), {}).fields.smooth);
  EXPECT_TRUE(make_plan(*load(flat), {}).fields.smooth);
  for (const RenderRequest& request : {in_double(), in_float()}) {
    EXPECT_TRUE(identical(seen(plain, true, request), seen(flat, true, request)));
    Json both = flat;
    both["objects"].push_back(placed(ball(8, 4), 0.5, Vec3d(20, 0, 0)));  // out of view
    EXPECT_TRUE(identical(seen(both, false, request), seen(both, true, request)));
  }
}

// Materials that transmit light keep the geometric side of the light.
TEST(Terminator, TransmittingMaterialsKeepTheirBits) {
  for (const char* material :
       {"{'type': 'translucent'}", "{'type': 'glass', 'roughness': 0.5, 'ior': 1.5}"}) {
    const Json scene = lit(ball(16, 8), kSun, json(material));
    EXPECT_TRUE(identical(seen(scene, false), seen(scene, true))) << material;
  }
}

RenderRequest by(const char* technique, int samples) {
  RenderRequest request;
  request.technique = technique;
  request.samples = samples;
  request.width = request.height = 32;
  return request;
}

// Returns the number of pixels with light of the source, for some techniques.
int lit_pixels(const Json& scene) {
  int count = 0;
  for (const RenderRequest& request : {by("whitted", 4), by("distributed", 4), by("path", 4)}) {
    const Picture picture = seen(scene, true, request);
    for (const Vec3f& pixel : picture.pixels) count += pixel.x > 0 && pixel.x < kBackground;
  }
  return count;
}

// Both sides of a closed box are dark if the light is on the other side, for any normals.
TEST(Terminator, ClosedBoxesLetNoLightThrough) {
  Random random(1);
  for (int i = 0; i < (reduced() ? 8 : 40); ++i) {
    const double thickness = random.magnitude(1e-4, 1);
    Json box = cube(Vec3d(-1, -thickness, -1), Vec3d(1, thickness, 1), true);
    if (i % 2 == 0)
      for (Json& normal : box["normals"])
        normal = numbers(safe_normalize(vector(normal) + random.direction() * random.between(0, 2)));
    const Vec3d inside(random.between(-0.9, 0.9), thickness * random.between(-0.9, 0.9),
                       random.between(-0.9, 0.9)),
        outside = random.direction() * random.magnitude(1.8, 5);
    for (const bool within : {true, false}) {
      const Json light = {{"type", "point"}, {"position", numbers(within ? inside : outside)}};
      Json scene = lit(box, light);
      scene["camera"] = {{"type", "perspective"},
                         {"eye", numbers(within ? outside : inside)},
                         {"look_at", within ? Json{0, 0, 0} : numbers(random.direction() * 3.0)},
                         {"fov_degrees", within ? 60 : 120}};
      scene["background"] = {0, 0, 0};
      EXPECT_EQ(lit_pixels(scene), 0) << scene.dump();
    }
  }
}

// The curved surface of a smooth box is outside the flat box around it.
TEST(Terminator, LiftsDoNotPassThroughOtherObjects) {
  const Vec3d size(1, 1, 1);
  Random random(2);
  for (int i = 0; i < (reduced() ? 4 : 20); ++i) {
    const Vec3d at = random.direction() * 3.0;
    Json scene = lit({cube(-size, size, true), cube(size * -1.01, size * 1.01, false, false)},
                     Json{{"type", "point"}, {"position", numbers(at)}});
    const Vec3d eye = random.direction();
    scene["camera"] = {{"type", "perspective"},
                       {"eye", numbers(eye * (1.005 / max_component(abs(eye))))},
                       {"look_at", {0, 0, 0}},
                       {"fov_degrees", 150}};
    EXPECT_EQ(lit_pixels(scene), 0) << scene.dump();
  }
}

// A light between the triangle and its curved surface reaches no point that it does not face, and the shadow
// of an object near the light follows the light.
TEST(Terminator, ShadowRaysEndAtTheLight) {
  Json light = json("{'type': 'point', 'position': [3, 0, 0]}");
  const Json blind =
      json("{'type': 'disk', 'center': [2.95, 0, 0], 'normal': [1, 0, 0], 'radius': 0.02, 'material': 'it'}");
  // The disk hides the light from the whole ball: its shadow is 0.4 wide per metre.
  Json scene = lit({ball(16, 8), blind}, light);
  const Picture dark = seen(scene, true);
  EXPECT_EQ(rms_on_objects(dark, seen(scene, false)), 0);
  const Json wall = json("{'type': 'plane', 'point': [3.01, 0, 0], 'normal': [-1, 0, 0], 'material': 'it'}");
  EXPECT_TRUE(identical(seen(lit({ball(16, 8)}, light), true), [&] {
    Picture with_wall = seen(lit({ball(16, 8), wall}, light), true);
    const Picture alone = seen(lit({ball(16, 8)}, light), true);
    for (std::size_t i = 0; i < alone.pixels.size(); ++i)
      if (alone.pixels[i].x > kBackground) with_wall.pixels[i] = alone.pixels[i];
    return with_wall;
  }()));
}

// Instances and moving meshes have the terminator of the mesh at rest.
TEST(Terminator, InstancesAndMovingMeshesAreSmooth) {
  const Json instanced = json(
      "{'objects': [], 'models': {}, 'instances': [{'model': 'm', 'scale': [1.3, 0.8, 1], 'rotate': {'axis': "
      "[1, 2, 3], 'degrees': 40}}]}");
  const auto placed_model = [&](const Json& object) {
    Json scene = lit(object, kSun);
    scene.merge_patch(instanced);
    scene["models"]["m"]["objects"] = {object};
    return scene;
  };
  const Json sphere = json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}");
  const Picture right = seen(placed_model(sphere), true);
  const double before = rms_on_objects(seen(placed_model(ball(16, 8)), false), right, true),
               after = rms_on_objects(seen(placed_model(ball(16, 8)), true), right, true);
  EXPECT_LE(after, before / 4);
  Json mesh = ball(16, 8), instance = lit(ball(16, 8), kSun);
  instance.merge_patch(json("{'objects': [], 'models': {}, 'instances': [{'model': 'm'}]}"));
  instance["models"]["m"]["objects"] = {mesh};
  mesh["motion"] = instance["instances"][0]["motion"] = Json::array();
  for (const double time : {0.0, 1.0}) {
    instance["instances"][0]["motion"].push_back({{"time", time}, {"translate", {0, 0, 2 * time}}});
    Json moved = ball(16, 8)["positions"];
    for (Json& at : moved) at[2] = at[2].get<double>() + 2 * time;
    mesh["motion"].push_back({{"time", time}, {"positions", moved}});
  }
  RenderRequest open = in_double();
  open.shutter = 1;
  open.samples = 4;
  const Picture by_instance = seen(instance, true, open);
  EXPECT_LE(rms_on_objects(seen(lit(mesh, kSun), true, open), by_instance), 1e-3);
  EXPECT_GT(rms_on_objects(seen(lit(mesh, kSun), false, open), by_instance), 5e-3);
}

// Paths find the light of lamps and environments beyond the plane of a triangle by light sampling alone. The
// mean radiance is that of the sphere.
TEST(Terminator, PathsMatchSphere) {
  const Json sphere = json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}");
  const Json lamp = json("{'type': 'sphere', 'center': [30, 6, 3], 'radius': 12, 'material': 'lamp'}");
  const auto with_lamp = [&](const Json& object) {
    Json scene = lit({object, lamp}, kSun);
    scene["lights"] = Json::array();
    scene["materials"]["lamp"] = json("{'type': 'lambert', 'reflectance': 0, 'emission': [6.6, 6.6, 6.6]}");
    scene["background"] = {0, 0, 0};
    return scene;
  };
  RenderRequest request = by("path", reduced() ? 64 : 256);
  request.reuse = 1;
  const Picture right = seen(with_lamp(sphere), true, request);
  const double before = rms_on_objects(seen(with_lamp(ball(16, 8)), false, request), right, true),
               after = rms_on_objects(seen(with_lamp(ball(16, 8)), true, request), right, true);
  EXPECT_LE(after, before / 2);
}

// `distributed` lights diffuse lobes by light sampling alone. In `path`, no sampled direction shares the
// light below the plane of the triangle, so light sampling has the weight 1.
TEST(Terminator, LightBelowThePlaneHasFullWeightInPaths) {
  const Json leaning = json(
      "{'type': 'mesh', 'positions': [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], 'indices': [[0, 1, 2]],"
      " 'normals': [[-1.5, -0.9, 1], [1.5, -0.9, 1], [0, 1.7, 1]], 'material': 'it'}");
  const Json lamp = json(
      "{'type': 'rectangle', 'corner': [1.2, -4, -0.01], 'edge_u': [0, 6, 0], 'edge_v': [0, 0, -3],"
      " 'material': 'lamp'}");
  Json scene = lit({leaning, lamp}, kSun, json("{'type': 'lambert', 'reflectance': 1}"));
  scene["lights"] = Json::array();
  scene["materials"]["lamp"] = json("{'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}");
  scene["background"] = {0, 0, 0};
  const std::vector<Ray<double>> rays(kBatch, Ray<double>{Vec3d(0.6, -0.8, 3), Vec3d(0, 0, -1)});
  const auto mean = [&](const char* technique) {
    Tracing tracing(scene, by(technique, 1));
    double sum = 0;
    for (int sample = 0; sample < 256; ++sample)
      for (const TraceOutput& output : tracing.trace(rays, sample)) sum += output.radiance.x;
    return sum / (256 * kBatch);
  };
  const double expected = mean("distributed");
  EXPECT_GT(expected, 0.01);
  EXPECT_NEAR(mean("path") / expected, 1, 2e-3);
}

}  // namespace
}  // namespace orrery::test
