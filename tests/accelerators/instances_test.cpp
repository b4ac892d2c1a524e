#include <cmath>

#include "core/accelerators/registry.h"
#include "core/math/affine.h"
#include "core/prepare/geometry.h"
#include "tests/support/agreement.h"
#include "tests/support/batches.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Tests that instances of models return the same hits as the list and as baked meshes.
namespace orrery::test {
namespace {

// Returns a closed triangle mesh that approximates the unit sphere.
Json ball_mesh(int rows, int columns) {
  Json positions = Json::array(), indices = Json::array();
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double u = M_PI * row / rows, v = 2 * M_PI * column / columns;
      positions.push_back({std::sin(u) * std::cos(v), std::cos(u), std::sin(u) * std::sin(v)});
    }
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int a = row * columns + column, b = row * columns + (column + 1) % columns;
      if (row > 0) indices.push_back({a, b, a + columns});
      if (row + 1 < rows) indices.push_back({b, b + columns, a + columns});
    }
  return {{"type", "mesh"}, {"positions", positions}, {"indices", indices}, {"material", "white"}};
}

struct Place {
  Vec3d scale, axis, move;
  double degrees;

  Json json() const {
    return {{"model", "it"},
            {"scale", numbers(scale)},
            {"rotate", {{"axis", numbers(axis)}, {"degrees", degrees}}},
            {"translate", numbers(move)}};
  }
  Affined world_from_model() const {
    const Affined turn = rotation(safe_normalize(axis), degrees);
    return {turn.x * scale.x, turn.y * scale.y, turn.z * scale.z, move};
  }
};

const std::vector<Place> kPlaces{{{1, 1, 1}, {0, 1, 0}, {0, 0, 0}, 0},
                                 {{-1, 1, 1}, {0, 1, 0}, {3, 0, 0}, 0},
                                 {{0.2, 2, 1}, {1, 2, 3}, {-3, 1, 0}, 70},
                                 {{-0.5, -0.5, -3}, {1, 0, 1}, {0, 4, 1}, 200},
                                 {{0.01, 0.02, 0.01}, {0, 0, 1}, {1.5, 0, 0}, 33},
                                 {{2, 2, 0.004}, {1, 1, 0}, {0, -4, 0}, 30}};

// A scene needs at least one object. This sphere is far from the instances.
const Json kSpeck = {{"type", "sphere"}, {"center", {0, -500, 0}}, {"radius", 0.001}};

Json scene_of_places(const Json& model, const Json& objects = kSpeck) {
  Json scene = scene_with(objects);
  scene["models"] = {{"it", {{"objects", Json::array({model})}}}};
  for (const Place& place : kPlaces) scene["instances"].push_back(place.json());
  return scene;
}

// Returns scene_of_places(model) with every instance baked into a separate mesh.
Json baked_scene(const Json& model) {
  Json objects = Json::array({kSpeck});
  for (const Place& place : kPlaces) {
    Json mesh = model;
    for (Json& position : mesh["positions"])
      position = numbers(place.world_from_model().point(vector(position)));
    objects.push_back(mesh);
  }
  return scene_with(objects);
}

template <class T>
Rays<T> rays_around(int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  while (static_cast<int>(rays.size()) < count) {  // half of the origins have several, coherent rays
    const Vec3d from = random.in_cube(7), to = random.in_cube(3);
    for (int i = 0; i < (random.below(2) ? 16 : 1); ++i)
      rays.push_back({Vec3<T>(from), Vec3<T>(safe_normalize(to + random.in_cube(0.05) - from))});
  }
  return rays;
}

class Instances : public StructureTest {};

TEST_P(Instances, MatchesList) {
  covers("F1 A38");
  Json mixed = scene_of_places(
      ball_mesh(8, 12), Json::array({{{"type", "sphere"}, {"center", {1, 1, 1}}, {"radius", 0.8}},
                                     {{"type", "plane"}, {"point", {0, -2, 0}}, {"normal", {0, 1, 0}}}}));
  mixed["models"]["it"]["objects"].push_back({{"type", "cylinder"},
                                              {"base", {0, 0, 0}},
                                              {"top", {0, 2, 0}},
                                              {"radius", 0.3},
                                              {"material", "white"}});
  agree<float>(mixed, rays_around<float>(50'000, 1), {0.7f, 5.0f, 1e30f});
  agree<double>(mixed, rays_around<double>(50'000, 2), {0.7, 5.0, 1e30});
}

// In model coordinates, these rays start millions of metres away from a ball of radius 1.
TEST_P(Instances, MatchesListWhenScaledToMillionthAlongOneAxis) {
  covers("A27 A38");
  Json scene = scene_of_places(ball_mesh(8, 12));
  for (const char* object :
       {R"({'type': 'sphere', 'center': [0.2, 0.1, 0], 'radius': 0.9})",
        R"({'type': 'cylinder', 'base': [0, -1, 0], 'top': [0.1, 1, 0.3], 'radius': 0.3})",
        R"({'type': 'box', 'min': [-0.5, -0.9, -0.3], 'max': [0.4, 0.9, 0.7]})",
        R"({'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 1, 0.1], 'radius': 1})"}) {
    scene["models"]["it"]["objects"].push_back(json(object));
    scene["models"]["it"]["objects"].back()["material"] = "white";
  }
  scene["instances"] = Json::array();
  for (const double turn : {0.0, 50.0})
    scene["instances"].push_back({{"model", "it"},
                                  {"scale", {-1.2e-6, 133, 12}},
                                  {"rotate", {{"axis", {1, 2, 3}}, {"degrees", turn}}}});
  Random random(6);
  Rays<float> rays;
  for (int i = 0; i < 100'000; ++i) {
    const double angle = random.between(0, 2 * M_PI), share = random.below(2) ? 1 : random.unit();
    const Vec3d from = random.in_cube(200),
                to = Vec3d(0, 133 * std::cos(angle), 12 * std::sin(angle)) * share + random.in_cube(0.3);
    rays.push_back({Vec3f(from), Vec3f(safe_normalize(to - from))});
  }
  agree<float>(scene, rays, {50.0f, 1e30f});
}

TEST_P(Instances, MatchesListOnUnboundedPlanes) {
  covers("F5 A38");
  const Json scene = scene_of_places(
      {{"type", "plane"}, {"point", {0, -1, 0}}, {"normal", {0, 1, 0}}, {"material", "white"}});
  agree<float>(scene, rays_around<float>(5'000, 3), {1e30f});
}

TEST_P(Instances, CountsTestsInsideInstances) {
  const Json model = ball_mesh(8, 12);
  Structure<float> structure(scene_of_places(model), GetParam());
  const auto rays = rays_around<float>(1'000, 9);
  structure.closest(rays);
  structure.occluded(rays, 1e30f);
  const AcceleratorCounts& counts = structure.counts();
  EXPECT_GT(counts.primitive_tests, 1'000u);
  EXPECT_GT(counts.primitive_tests + counts.box_tests + counts.node_visits, 20'000u)
      << "of 168 triangles each";
}

INSTANTIATE_TEST_SUITE_P(All, Instances, testing::ValuesIn(accelerator_names()), parameter_name);

TEST(Instance, MatchesBakedMesh) {
  covers("A38");
  const Json model = ball_mesh(8, 12);
  Structure<double> placed(scene_of_places(model), "bottom-up"), baked(baked_scene(model), "bottom-up");
  const Rays<double> rays = rays_around<double>(100'000, 4);
  const auto found = placed.closest(rays), expected = baked.closest(rays);
  int met = 0, other = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    met += expected[i].met();
    if (found[i].primitive != expected[i].primitive) {  // at an edge, rounding decides which triangle is hit
      ++other;
      continue;
    }
    if (!expected[i].met()) continue;
    EXPECT_NEAR(found[i].t, expected[i].t, 1e-12 * std::max(1.0, expected[i].t));
  }
  EXPECT_GT(met, 20'000);
  EXPECT_LE(other, 5);
}

// Returns the distance to the ellipsoid that a place makes of the unit sphere, or infinity. Solves the
// quadric in long double. Sets `grazing` if the ray nearly touches the ellipsoid.
long double ellipsoid_distance(const Place& place, const Ray<double>& ray, bool& grazing) {
  using Vec = Vec3<long double>;
  const Affined map = place.world_from_model();
  const Vec x(map.x), y(map.y), z(map.z);
  const long double determinant = dot(x, cross(y, z));
  const auto in_model = [&](const Vec& v) {
    return Vec(dot(v, cross(y, z)), dot(v, cross(z, x)), dot(v, cross(x, y))) / determinant;
  };
  const Vec o = in_model(Vec(ray.origin) - Vec(map.origin)), d = in_model(Vec(ray.direction));
  const long double a = dot(d, d), b = dot(o, d), c = dot(o, o) - 1;
  const Vec nearest = o - d * (b / a);
  const long double inside = 1 - dot(nearest, nearest);
  grazing = grazing || std::abs(inside) < 1e-3L;
  if (inside < 0) return std::numeric_limits<long double>::infinity();
  const long double root = std::sqrt(a * inside), near = (-b - root) / a, far = (-b + root) / a;
  grazing = grazing || std::abs(c) < 1e-3L;
  return near > 0 ? near : far > 0 ? far : std::numeric_limits<long double>::infinity();
}

TEST(Instance, MakesEllipsoidOfSphere) {
  covers("A38");
  const Json ball = {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "white"}};
  Structure<double> placed(scene_of_places(ball), "bottom-up");
  const Rays<double> rays = rays_around<double>(50'000, 6);
  const auto found = placed.closest(rays);
  long double worst = 0;
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    bool grazing = false;
    long double exact = std::numeric_limits<long double>::infinity();
    for (const Place& place : kPlaces) exact = std::min(exact, ellipsoid_distance(place, rays[i], grazing));
    if (grazing || (found[i].met() && found[i].primitive == 0)) continue;
    ASSERT_EQ(found[i].met(), std::isfinite(exact));
    if (!found[i].met()) continue;
    ++met;
    worst = std::max(worst, std::abs(static_cast<long double>(found[i].t) - exact) / std::max(exact, 1.0L));
  }
  std::printf("ellipsoids: largest relative error %.2Lg of %d hits\n", worst, met);
  EXPECT_LE(worst, 1e-12L);
  EXPECT_GT(met, 10'000);
}

// Returns the outward normal of a triangle of a placed ball, in world coordinates.
Vec3d world_normal(const Json& model, std::size_t triangle, const Place& place) {
  const Affined world_from_model = place.world_from_model();
  std::array<Vec3d, 3> corner;
  for (std::size_t k = 0; k < 3; ++k)
    corner[k] =
        world_from_model.point(vector(model["positions"][model["indices"][triangle][k].get<std::size_t>()]));
  const Vec3d normal = safe_normalize(cross(corner[1] - corner[0], corner[2] - corner[0]));
  return dot(normal, corner[0] - place.move) < 0 ? -normal : normal;
}

// Expects the outward normal of the triangle at hits from outside. A ray that leaves along this normal must
// not hit the same instance.
template <class T>
void expect_outward_and_clear() {
  const Json model = ball_mesh(24, 48), json = scene_of_places(model);
  const auto scene = load(json);
  for (const auto& type : accelerator_types()) {
    if (std::string(type.name) != "bottom-up") continue;
    const auto geometry = make_geometry<T>(scene, type);
    const auto accelerator = build(type, geometry->primitives);
    const auto batch = std::make_unique<RayBatch<T>>();
    const auto hits = std::make_unique<HitBatch<T>>();
    const auto surface = std::make_unique<SurfaceBatch<T>>();
    AcceleratorCounts counts;
    constexpr double kTolerance = std::is_same_v<T, float> ? 1e-4 : 1e-10;
    int met = 0, wrong = 0, stuck = 0;
    const Rays<T> rays = rays_around<T>(100'000, 5);
    for_each_batch<T>(rays, [&](std::span<const Ray<T>> some, std::size_t) {
      fill_batch(some, std::numeric_limits<T>::max(), *batch);
      hits->t.values = batch->t_max.values;
      hits->primitive.values.fill(kNoPrimitive);
      accelerator->closest(*batch, groups_of(*batch), *hits, counts);
      for (const auto& shapes : geometry->shapes) shapes->surface(*batch, *hits, groups_of(*batch), *surface);
      Rays<T> leaving;
      std::vector<int> instance;
      const int per = static_cast<int>(scene->models.front().material_of.size());
      for (int i = 0; i < batch->count; ++i) {
        if (hits->primitive[i] == kNoPrimitive) continue;
        const auto which = static_cast<std::size_t>((hits->primitive[i] - 1) / per);
        const Vec3<T> normal = surface->geometric[i], position = surface->position[i];
        const double least = std::min({std::abs(kPlaces[which].scale.x), std::abs(kPlaces[which].scale.y),
                                       std::abs(kPlaces[which].scale.z)});
        EXPECT_LT(static_cast<double>(surface->step[i]), 0.02 * least) << "offset crosses the instance";
        if (surface->side[i] < 0) continue;  // hit from inside
        ++met;
        const auto triangle = static_cast<std::size_t>((hits->primitive[i] - 1) % per);
        wrong += length(Vec3d(normal) - world_normal(model, triangle, kPlaces[which])) > kTolerance;
        leaving.push_back({position + normal * surface->step[i], normal});
        instance.push_back(static_cast<int>(which));
      }
      if (leaving.empty()) return;
      fill_batch<T>(leaving, std::numeric_limits<T>::max(), *batch);
      hits->t.values = batch->t_max.values;
      hits->primitive.values.fill(kNoPrimitive);
      accelerator->closest(*batch, groups_of(*batch), *hits, counts);
      for (std::size_t k = 0; k < leaving.size(); ++k) {
        const auto id = hits->primitive[static_cast<int>(k)];
        stuck += id != kNoPrimitive && (id - 1) / per == instance[k];
      }
    });
    EXPECT_GT(met, 20'000);
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(stuck, 0);
  }
}

TEST(Instance, ReturnsOutwardNormalsAndClearOffsetsAtAnyScale) {
  covers("A38 A16");
  expect_outward_and_clear<float>();
  expect_outward_and_clear<double>();
}

}  // namespace
}  // namespace orrery::test
