#include "core/raster/tile_raster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/plan/plan.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// Compares the visible triangles of random meshes with an exhaustive search in exact arithmetic.
namespace orrery::test {
namespace {

constexpr int kWidthPixels = 75, kHeightPixels = 64;

// Triangles with corners at integer subpixels, in front of a parallel camera whose pixels are 1/16 m wide.
struct Mesh {
  struct Corner {
    std::int64_t x, y;  // subpixels
    double z;           // metres
  };
  std::vector<std::array<Corner, 3>> triangles;

  Json scene() const {
    Json mesh = {{"type", "mesh"}, {"positions", Json::array()}, {"indices", Json::array()}};
    for (const auto& triangle : triangles) {
      const std::size_t first = mesh["positions"].size();
      mesh["indices"].push_back({first, first + 1, first + 2});
      for (const Corner& corner : triangle)
        mesh["positions"].push_back({(double(corner.x) / kSubpixels - kWidthPixels / 2.0) / 16,
                                     (kHeightPixels / 2.0 - double(corner.y) / kSubpixels) / 16, corner.z});
    }
    return scene_with(mesh,
                      json("{'camera': {'type': 'orthographic', 'eye': [0, 0, 4], 'look_at': [0, 0, 0], "
                           "'height': 4}}"));
  }
};

std::int64_t area_of(const std::array<Mesh::Corner, 3>& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
}

// Returns random triangles from a tenth of a pixel to half the image, some of them twice.
Mesh random_mesh(int count, Random& random) {
  Mesh mesh;
  while (static_cast<int>(mesh.triangles.size()) < count) {
    const double size = std::exp2(random.between(-3.0, random.below(20) == 0 ? 5.0 : 2.0)) * kSubpixels;
    const double x = random.between(-5.0, kWidthPixels + 5.0) * kSubpixels;
    const double y = random.between(-5.0, kHeightPixels + 5.0) * kSubpixels;
    // Coarse grids put corners and edges on samples.
    const double grid = random.below(3) == 0 ? kSubpixels / 2 : 1;
    const double z = random.between(-2.0, 2.0);
    std::array<Mesh::Corner, 3> triangle;
    for (Mesh::Corner& corner : triangle)
      corner = {static_cast<std::int64_t>(std::round((x + random.between(-size, size)) / grid) * grid),
                static_cast<std::int64_t>(std::round((y + random.between(-size, size)) / grid) * grid),
                z + random.between(-0.5, 0.5)};
    if (area_of(triangle) == 0) continue;
    mesh.triangles.push_back(triangle);
    if (random.below(10) == 0) mesh.triangles.push_back(triangle);
  }
  return mesh;
}

// Returns the triangles that cover a sample, the nearest first. Triangles of equal depth are in their order.
// A sample on an edge is covered if it is inside after it moved right, and far less downward.
std::vector<int> covering(const Mesh& mesh, std::int64_t x, std::int64_t y) {
  std::vector<std::pair<long double, int>> found;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& t = mesh.triangles[n];
    const std::int64_t area = area_of(t), side = area < 0 ? -1 : 1;
    bool inside = true;
    long double z = 0;
    for (std::size_t k = 0; k < 3 && inside; ++k) {
      const Mesh::Corner &from = t[(k + 1) % 3], &to = t[(k + 2) % 3];
      const std::int64_t dx = (to.x - from.x) * side, dy = (to.y - from.y) * side;
      const std::int64_t edge = dx * (y - from.y) - dy * (x - from.x);
      inside = edge > 0 || (edge == 0 && (dy < 0 || (dy == 0 && dx > 0)));
      z += static_cast<long double>(edge) * t[k].z;
    }
    if (inside) found.emplace_back(-z / static_cast<long double>(area * side), static_cast<int>(n));
  }
  std::sort(found.begin(), found.end());
  std::vector<int> numbers;
  for (const auto& [depth, number] : found) numbers.push_back(number);
  return numbers;
}

class VisibleTriangles : public testing::TestWithParam<int> {};

// Layer by layer, each sample shows the next triangle.
TEST_P(VisibleTriangles, EqualThoseOfExhaustiveSearch) {
  Random random(7);
  const Mesh mesh = random_mesh(18'000, random);
  const auto scene = load(mesh.scene());
  RenderRequest request = size(kWidthPixels, kHeightPixels);
  request.technique = "phong";
  request.samples = GetParam();
  const Plan plan = make_plan(*scene, request);
  const auto screen = make_screen(scene, plan);
  ASSERT_GT(screen->chunks.size(), 1u);
  const TileGrid grid(kWidthPixels, kHeightPixels);
  auto raster = std::make_unique<TileRaster>(*screen, true);
  std::array<int, 4> seen{};  // by layer
  for (int t = 0; t < grid.size(); ++t) {
    const TileView tile = grid.at(t, 1);
    TileSamples samples = TileSamples::centres();
    std::array<std::vector<int>, kBatch> expected;
    std::array<bool, kBatch> wanted{};
    for (int slot = 0; slot < kBatch; ++slot) {
      if (GetParam() > 1) {
        samples.u[slot] = static_cast<float>(random.between(0.0, 0.999));
        samples.v[slot] = static_cast<float>(random.between(0.0, 0.999));
      }
      const TilePixel pixel = tile_pixel(slot);
      if (pixel.x >= tile.width || pixel.y >= tile.height) continue;
      const auto subpixel = [](int at, float within) {
        return static_cast<std::int64_t>(std::floor((at + double{within}) * kSubpixels));
      };
      expected[static_cast<std::size_t>(slot)] = covering(mesh, subpixel(tile.x0 + pixel.x, samples.u[slot]),
                                                          subpixel(tile.y0 + pixel.y, samples.v[slot]));
    }
    raster->draw(tile, samples);
    for (std::size_t layer = 0; layer < seen.size(); ++layer) {
      for (std::size_t slot = 0; slot < kBatch; ++slot) {
        const TilePixel pixel = tile_pixel(static_cast<int>(slot));
        if (pixel.x >= tile.width || pixel.y >= tile.height) continue;
        const bool covered = raster->covered(static_cast<int>(slot));
        wanted[slot] = expected[slot].size() > layer;
        ASSERT_EQ(covered, wanted[slot]) << t << ' ' << slot << " layer " << layer;
        if (!covered) continue;
        ASSERT_EQ(screen->primitive(raster->triangle(static_cast<int>(slot))), expected[slot][layer])
            << t << ' ' << slot << " layer " << layer;
        ++seen[layer];
      }
      raster->peel(wanted);
    }
  }
  for (const int count : seen) EXPECT_GT(count, kWidthPixels * kHeightPixels / 2);
}

INSTANTIATE_TEST_SUITE_P(Samples, VisibleTriangles, testing::Values(1, 4));

// Meshes of a scene are drawn where they are stored, meshes of an instance are copied. A ball between the
// meshes is tessellated.
TEST(Screen, DrawsStoredAndCopiedMeshesEqually) {
  Random random(3);
  const Json mesh = random_mesh(2000, random).scene()["objects"][0];
  Json scene = scene_with(Json::array(), json(R"({
      'materials': {'red': {'type': 'lambert', 'kd': null, 'ka': null, 'emission': [1, 0.1, 0]},
                    'green': {'type': 'lambert', 'kd': null, 'ka': null, 'emission': [0, 0.9, 0.2]}}})"));
  Json objects = Json::array(
      {json("{'type': 'sphere', 'center': [0.5, 0, 0], 'radius': 0.7, 'material': 'green'}"), mesh,
       json(
           "{'type': 'triangle', 'vertices': [[-2, 0, 0.2], [-1, 0, 0.2], [-1, 1, 0.2]], 'material': 'red'}"),
       mesh});
  const Json speck =
      json("{'type': 'triangle', 'vertices': [[0, 0, 3], [0.1, 0, 3], [0, 0.1, 3]], 'material': 'green'}");
  for (int i = 0; i < 500; ++i) objects.push_back(speck);  // numbered before the meshes
  for (Json& position : objects[3]["positions"]) position[2] = position[2].get<double>() + 0.3;
  objects[1]["material"] = "red";
  objects[3]["material"] = "green";
  scene["objects"] = objects;
  Json copied = scene;
  copied["objects"] = Json::array();
  copied["models"] = {{"all", {{"objects", objects}}}};
  copied["instances"] = {{{"model", "all"}}};
  for (const char* technique : {"flat", "gouraud", "phong"})
    for (const int samples : {1, 2}) {
      RenderRequest request = size(kWidthPixels, kHeightPixels);
      request.technique = technique;
      request.samples = samples;
      const Picture picture = render(scene, request);
      EXPECT_TRUE(identical(picture, render(copied, request))) << technique << ' ' << samples;
      EXPECT_GT(picture.sum(&Vec3f::x), 500);
      EXPECT_GT(picture.sum(&Vec3f::y), 500);
    }
}

}  // namespace
}  // namespace orrery::test
