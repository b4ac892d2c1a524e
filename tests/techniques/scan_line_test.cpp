#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/model/tessellation.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

// Tests the scan line techniques: coverage, interpolation and lighting.
namespace orrery::test {
namespace {

constexpr int kSide = 64;  // pixels of most images

RenderRequest by(const char* technique, int side = kSide) {
  RenderRequest request = size(side, side);
  request.technique = technique;
  return request;
}
RenderRequest in_screen(RenderRequest request) {
  request.interpolation = Interpolation::screen;
  return request;
}

// Parallel camera that sees 4 m, so that a pixel is 1/16 m wide.
Json parallel_camera(const Vec3d& eye = {0, 0, 4}) {
  return {{"type", "orthographic"}, {"eye", numbers(eye)}, {"look_at", {0, 0, 0}}, {"height", 4}};
}

bool covered(const Picture& picture, int x, int y) { return picture.at(x, y).x > 0; }

// Returns the scene with one emitting material, so that covered pixels have radiance 1.
Json glowing(const Json& objects, Json patch = Json::object()) {
  patch["materials"] = json("{'white': {'type': 'lambert', 'kd': null, 'ka': null, 'emission': [1, 1, 1]}}");
  return scene_with(objects, patch);
}

// Returns whether a pixel or one of its eight neighbours differs in coverage from (x, y).
bool near_silhouette(const Picture& picture, int x, int y) {
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, picture.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, picture.width - 1); ++i)
      if (covered(picture, i, j) != covered(picture, x, y)) return true;
  return false;
}
void expect_same_silhouette(const Json& scene, int least_covered) {
  const Picture cast = render(scene, by("raycast")), drawn = render(scene, by("phong"));
  int count = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      count += covered(cast, x, y);
      EXPECT_TRUE(covered(cast, x, y) == covered(drawn, x, y) || near_silhouette(cast, x, y))
          << x << ' ' << y;
    }
  EXPECT_GE(count, least_covered);
}

TEST(ScanLine, HasSilhouetteOfRayCastingForEveryShape) {
  for (const std::string& type : shape_names())
    for (const Json& object : shape_samples(type)) {
      SCOPED_TRACE(object.dump());
      expect_same_silhouette(glowing(object, json("{'camera': {'eye': [1, 1.5, 3.5]}}")), 8);
      expect_same_silhouette(glowing(object, Json{{"camera", parallel_camera({1, 1.5, 3.5})}}), 8);
    }
}

// The eye is inside the cylinders and the ball, and close to the floors. Triangles extend behind the eye.
TEST(ScanLine, ClipsTrianglesBehindEye) {
  const char* const objects[] = {
      "{'type': 'cylinder', 'base': [0, 0, -20], 'top': [0, 0, 20], 'radius': 0.5}",
      "{'type': 'cylinder', 'point': [0.2, 0, 0], 'axis': [0.3, 0.1, 1], 'radius': 0.7}",
      "{'type': 'triangle', 'vertices': [[-90, -0.01, 50], [90, -0.01, 50], [0, -0.01, -50]]}",
      "{'type': 'plane', 'point': [0, -0.001, 0], 'normal': [0, 1, 0]}",
      "{'type': 'sphere', 'center': [0.3, 0, 4], 'radius': 0.9}",
      "{'type': 'rectangle', 'corner': [-1, 0.5, -1000], 'edge_u': [0, 0, 2000], 'edge_v': [2, 0, 0]}"};
  for (const char* object : objects) {
    SCOPED_TRACE(object);
    expect_same_silhouette(glowing(json(object)), kSide * kSide / 8);
  }
}

// Vertices of a grid are at pixel centres, on pixel borders or in between. The even and the odd triangles
// together cover the image, and no pixel is covered twice.
TEST(ScanLine, CoversEachPixelOfMeshOnce) {
  Random random(7);
  constexpr int kCells = 24;
  for (const double grid : {1.0, 0.5, 0.25, 0.001}) {
    Json mesh = {{"type", "mesh"}, {"positions", Json::array()}};
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        const auto place = [&](int cell) {
          const double moved = cell + random.between(-0.3, 0.3);
          const double pixels =
              std::round(moved * (kSide + 8.0) / kCells / grid) * grid + (grid == 1 ? 0.5 : 0);
          return (pixels - 4 - kSide / 2.0) / 16;
        };
        const double x = place(i), y = place(j);
        mesh["positions"].push_back({x, y, 0});
      }
    Json even = Json::array(), odd = Json::array();
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const int a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
        even.push_back({a, b, d});
        odd.push_back({a, d, c});
      }
    const auto picture = [&](const Json& indices, int samples) {
      mesh["indices"] = indices;
      RenderRequest request = by("flat");
      request.samples = samples;
      return render(glowing(mesh, Json{{"camera", parallel_camera()}}), request);
    };
    for (const int samples : {1, 4}) {
      SCOPED_TRACE(testing::Message() << grid << " pixels, samples: " << samples);
      const Picture first = picture(even, samples), second = picture(odd, samples);
      for (std::size_t i = 0; i < first.pixels.size(); ++i)
        ASSERT_EQ(first.pixels[i].x + second.pixels[i].x, 1) << i % kSide << ' ' << i / kSide;
    }
  }
}

// Triangle at different depths. Its corners are at exact image coordinates for a field of view of 90 degrees.
struct SlantedTriangle {
  static constexpr std::array<std::array<double, 2>, 3> kPixels{{{8, 56}, {60, 40}, {24, 4}}};
  static constexpr std::array<double, 3> kDepths{2, 8, 4};

  std::array<Vec3d, 3> corners;
  SlantedTriangle() {
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] =
          Vec3d((kPixels[i][0] / 32 - 1) * kDepths[i], (1 - kPixels[i][1] / 32) * kDepths[i], 4 - kDepths[i]);
  }
  // Radiance of corner i: that of a white Lambert surface under a point light at [0, 3, 3].
  double radiance(std::size_t i) const {
    const Vec3d normal = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return std::max(0.0, dot(normal, normalize(Vec3d(0, 3, 3) - corners[i])));
  }
  Json scene() const {
    Json triangle = {{"type", "triangle"}, {"vertices", Json::array()}};
    for (const Vec3d& corner : corners) triangle["vertices"].push_back(numbers(corner));
    return scene_with(triangle,
                      json("{'camera': {'fov_degrees': 90}, 'materials': {'white': {'type': 'lambert', 'kd': "
                           "null, 'ka': null, 'reflectance': [1, 1, 1]}}, 'lights': [{'type': 'point', "
                           "'position': [0, 3, 3]}]}"));
  }
  // Returns the weights of the corners at a point of the image, linear in the image.
  Vec3d weights(double x, double y) const {
    const auto area = [&](std::array<double, 2> a, std::array<double, 2> b, std::array<double, 2> c) {
      return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    };
    const std::array<double, 2> p{x, y};
    const auto& [a, b, c] = kPixels;
    return Vec3d(area(p, b, c), area(a, p, c), area(a, b, p)) / area(a, b, c);
  }
};

// Renders the triangle as in the textbook: radiance is interpolated along two edges by adding a constant per
// scan line, and along the scan line by adding a constant per pixel. Pixels outside are -1.
std::vector<double> incremental_gouraud(const SlantedTriangle& triangle) {
  std::vector<double> image(kSide * kSide, -1);
  struct Edge {
    double x, radiance, dx, dradiance;
  };
  for (int y = 0; y < kSide; ++y) {
    std::vector<Edge> met;
    for (std::size_t i = 0; i < 3; ++i) {
      std::size_t top = i, bottom = (i + 1) % 3;
      if (SlantedTriangle::kPixels[top][1] > SlantedTriangle::kPixels[bottom][1]) std::swap(top, bottom);
      const auto& [x0, y0] = SlantedTriangle::kPixels[top];
      const auto& [x1, y1] = SlantedTriangle::kPixels[bottom];
      const double lines = y1 - y0, dx = (x1 - x0) / lines;
      const double dradiance = (triangle.radiance(bottom) - triangle.radiance(top)) / lines;
      if (y + 0.5 <= y0 || y + 0.5 > y1) continue;
      Edge edge{x0 + dx / 2, triangle.radiance(top) + dradiance / 2, dx, dradiance};  // first pixel centre
      for (int line = static_cast<int>(y0); line < y; ++line) {
        edge.x += edge.dx;
        edge.radiance += edge.dradiance;
      }
      met.push_back(edge);
    }
    if (met.size() < 2) continue;
    if (met[0].x > met[1].x) std::swap(met[0], met[1]);
    const double per_pixel = (met[1].radiance - met[0].radiance) / (met[1].x - met[0].x);
    const int first = static_cast<int>(std::ceil(met[0].x - 0.5));
    double radiance = met[0].radiance + (first + 0.5 - met[0].x) * per_pixel;
    for (int x = first; x + 0.5 < met[1].x; ++x, radiance += per_pixel)
      image[static_cast<std::size_t>(y * kSide + x)] = radiance;
  }
  return image;
}

TEST(Gouraud, EqualsIncrementalFormOnScreen) {
  const SlantedTriangle triangle;
  const Picture picture = render(triangle.scene(), in_screen(by("gouraud")));
  const std::vector<double> expected = incremental_gouraud(triangle);
  int inside = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    inside += expected[i] >= 0;
    EXPECT_NEAR(picture.pixels[i].x, std::max(expected[i], 0.0), 2e-6) << i % kSide << ' ' << i / kSide;
  }
  EXPECT_GT(inside, 500);
}

// Weights that are linear in the scene are those of the image divided by the depths of the corners.
TEST(Gouraud, InterpolatesLinearlyInSceneByDefault) {
  const SlantedTriangle triangle;
  const Picture picture = render(triangle.scene(), by("gouraud"));
  const Picture distorted = render(triangle.scene(), in_screen(by("gouraud")));
  int inside = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      if (!(picture.at(x, y).x > 0)) continue;
      ++inside;
      Vec3d weights = triangle.weights(x + 0.5, y + 0.5);
      for (std::size_t i = 0; i < 3; ++i) weights[i] /= SlantedTriangle::kDepths[i];
      weights = weights / (weights.x + weights.y + weights.z);
      double expected = 0;
      for (std::size_t i = 0; i < 3; ++i) expected += weights[i] * triangle.radiance(i);
      EXPECT_NEAR(picture.at(x, y).x, expected, 2e-6) << x << ' ' << y;
    }
  EXPECT_GT(inside, 500);
  EXPECT_GT(largest_difference(picture, distorted), 0.03) << "perspective distortion";
}

// A plane is exact as triangles, and a directional light gives the same radiance everywhere.
TEST(ScanLine, EqualsRayCastingOnPlanesUnderDirectionalLight) {
  const Json scene = scene_with(
      json("[{'type': 'rectangle', 'corner': [-9, -9, -1], 'edge_u': [18, 0, 3], 'edge_v': [0, 18, 0]},"
           "{'type': 'plane', 'point': [0, 0, -40], 'normal': [0, 0.1, 1]}]"),
      json("{'ambient': [0.1, 0.2, 0.3], 'lights': [{'type': 'directional', 'direction_to_light': "
           "[1, 2, 3]}]}"));
  const Picture cast = render(scene, by("raycast"));
  for (const char* technique : {"flat", "gouraud", "phong"})
    EXPECT_LE(largest_difference(cast, render(scene, by(technique))), 3e-7) << technique;
}

Json shiny_ball(const char* shape) {
  return scene_with(json(shape),
                    json("{'ambient': [0.1, 0.1, 0.1], 'lights': [{'type': 'point', 'position': [0, 0, "
                         "3]}], 'materials': {'white': {'kd': 0.4, 'ks': 0.6, 'shininess': 30}}}"));
}

// The ball is alone, so ray casting traces no shadows.
TEST(Phong, ConvergesToRayCastingOnBall) {
  const Json scene = shiny_ball("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1.2}");
  const Picture cast = render(scene, by("raycast"));
  double last = 1;
  for (const double error : {2.0, 0.25, 0.01}) {
    RenderRequest request = by("phong");
    request.tessellation_error = error;
    const Picture drawn = render(scene, request);
    double largest = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        if (!near_silhouette(cast, x, y))
          largest = std::max(largest, std::abs(double{cast.at(x, y).x} - double{drawn.at(x, y).x}));
    EXPECT_LT(largest, last / 2) << error;
    last = largest;
  }
  EXPECT_LT(last, 0.005);
}

// The highlight is in the middle of a rectangle, far from its corners.
TEST(Gouraud, LosesHighlightBetweenVertices) {
  const Json scene =
      shiny_ball("{'type': 'rectangle', 'corner': [-2, -2, 0], 'edge_u': [4, 0, 0], 'edge_v': [0, 4, 0]}");
  const auto brightest = [&](const char* technique) {
    const Picture picture = render(scene, by(technique));
    return picture.at(kSide / 2, kSide / 2).x;
  };
  EXPECT_NEAR(brightest("phong"), 0.1 * 0.4 + 0.4 + 0.6, 0.02);
  EXPECT_LT(brightest("gouraud"), 0.5);
}

// The mirrored instance keeps the normals of its faces outward.
TEST(ScanLine, ShadesMirroredInstancesFromOutside) {
  Json scene = scene_with(Json::array(), json(R"({
      'models': {'it': {'objects': [
          {'type': 'box', 'min': [-1, -1, -1], 'max': [0, 1, 0.5], 'material': 'white'},
          {'type': 'sphere', 'center': [0.6, 0, 0], 'radius': 0.5, 'material': 'white'}]}},
      'instances': [{'model': 'it', 'scale': [-1, 1.5, 1], 'rotate': {'axis': [0, 1, 0], 'degrees': 30}}],
      'lights': [{'type': 'directional', 'direction_to_light': [0.3, 0.2, 1]}]})"));
  const Picture cast = render(scene, by("raycast"));
  for (const char* technique : {"gouraud", "phong"})
    EXPECT_LT(differing_pixels(cast, render(scene, by(technique)), 0.04), 200) << technique;
}

TEST(ScanLine, GivesSameBytesForAnyThreadsAndSlices) {
  const Json scene = sample("technique-polygon-shading");
  for (const char* technique : {"flat", "gouraud", "phong"}) {
    RenderRequest request = by(technique, 100);
    request.samples = 2;
    const Picture picture = render(scene, request, 1);
    EXPECT_TRUE(identical(picture, render(scene, request, 3)));
    request.slice = 16;
    EXPECT_TRUE(identical(picture, render(scene, request, 2)));
    EXPECT_GT(picture.sum(), 1000);
  }
}

// Panes of colours k / 8 at z = 0, -1, ..., listed from the middle outward, over a background of 0.9.
Json panes(int count, const char* blend) {
  Json objects = Json::array(), materials;
  for (int k = 0; k < count; ++k) {
    const int place = (k * 3 + 1) % count;  // no order of depth
    const std::string name = "pane" + std::to_string(place);
    materials[name] = {{"type", "transparent"},
                       {"blend", blend},
                       {"ka", (place + 1) / 8.0},
                       {"kd", 0},
                       {"kt", 0.3 + 0.1 * place}};
    if (std::string_view(blend) == "filtered") materials[name]["transmission_color"] = {0.5, 0.8, 1};
    objects.push_back({{"type", "rectangle"},
                       {"corner", {-9, -9, -place}},
                       {"edge_u", {18, 0, 0}},
                       {"edge_v", {0, 18, 0}},
                       {"material", name}});
  }
  return scene_with(objects, {{"materials", materials},
                              {"ambient", {1, 1, 1}},
                              {"background", {0.9, 0.9, 0.9}},
                              {"camera", parallel_camera()}});
}

TEST(ScanLine, BlendsTransparentSurfacesInOrderOfDepth) {
  for (const char* technique : {"flat", "gouraud", "phong"})
    for (const char* blend : {"interpolated", "filtered"})
      for (const int count : {1, 2, 4, 5}) {
        SCOPED_TRACE(testing::Message() << technique << ' ' << blend << ' ' << count);
        const bool filtered = std::string_view(blend) == "filtered";
        Vec3d expected(0.9);
        for (int place = count - 1; place >= 0; --place) {
          const double kt = 0.3 + 0.1 * place, own = (place + 1) / 8.0;
          expected = filtered ? Vec3d(own) + Vec3d(0.5, 0.8, 1) * kt * expected
                              : Vec3d(own * (1 - kt)) + expected * kt;
        }
        const Picture picture = render(panes(count, blend), in_double(by(technique)));
        for (const int x : {0, 20, 63}) {
          EXPECT_NEAR(picture.at(x, 31).x, expected.x, 1e-6);
          EXPECT_NEAR(picture.at(x, 31).y, expected.y, 1e-6);
          EXPECT_NEAR(picture.at(x, 31).z, expected.z, 1e-6);
        }
      }
}

TEST(ScanLine, BlendsCoincidentTransparentSurfaces) {
  Json scene = panes(2, "interpolated");
  for (Json& object : scene["objects"]) object["corner"] = {-9, -9, 0};
  const Picture picture = render(scene, in_double(by("phong")));
  const auto blended = [](int front, int back) {
    const auto own = [](int place, double behind) {
      const double kt = 0.3 + 0.1 * place;
      return (place + 1) / 8.0 * (1 - kt) + kt * behind;
    };
    return own(front, own(back, 0.9));
  };
  EXPECT_NEAR(picture.at(31, 31).x, blended(1, 0), 1e-6) << "in the order of the file";
}

// Both faces of each ball, a ball inside another one, and opaque shapes in front and behind, without shadows.
TEST(ScanLine, BlendsTransparentBodiesAsWhitted) {
  Json scene = scene_of(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1.2, 'material': 'outer'},"
      " {'type': 'sphere', 'center': [0.2, 0.1, 0], 'radius': 0.6, 'material': 'inner'},"
      " {'type': 'box', 'min': [-0.4, -2, -3], 'max': [0.4, 2, -2], 'material': 'white'},"
      " {'type': 'sphere', 'center': [0.5, 0.2, 2], 'radius': 0.2, 'material': 'white'}]",
      "{'ambient': [1, 1, 1], 'background': [0.2, 0.5, 0.9]}");
  scene["materials"]["outer"] = {{"type", "transparent"}, {"kd", {0.8, 0.3, 0.1}}, {"kt", 0.6}};
  scene["materials"]["inner"] = {{"type", "transparent"},
                                 {"blend", "filtered"},
                                 {"kd", 0.1},
                                 {"kt", 0.8},
                                 {"transmission_color", {0.2, 1, 0.4}}};
  scene["camera"] = parallel_camera();
  const Picture drawn = render(scene, in_double(by("phong"))),
                traced = render(scene, in_double(by("whitted")));
  EXPECT_LE(differing_pixels(drawn, traced, 1e-6), 90) << "silhouettes";
}

TEST(ScanLine, RendersEverySampleScene) {
  for (const std::string& name : sample_names()) {
    const Json scene = sample(name);
    if (scene["camera"]["type"] == "panorama") continue;
    for (const char* technique : {"flat", "gouraud", "phong"}) {
      SCOPED_TRACE(name + " " + technique);
      const auto picture = [&](const char* by_technique) {
        RenderRequest request = by(by_technique, 48);
        request.samples = 1;
        request.shutter = 0;
        request.tessellation_error = 0.25;
        return render(scene, request);
      };
      const Picture drawn = picture(technique), cast = picture("raycast");
      EXPECT_EQ(drawn.stats.non_finite_pixels, 0u);
      EXPECT_NEAR(static_cast<double>(drawn.stats.counts.camera_hits),
                  static_cast<double>(cast.stats.counts.camera_hits), 48);
    }
  }
}

TEST(ScanLine, RejectsPanorama) {
  const Json scene =
      scene_with(json("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}"),
                 json("{'camera': {'type': 'panorama', 'eye': [0, 0, 4], 'look_at': [0, 0, 0]}}"));
  try {
    render(scene, by("gouraud"));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gouraud does not support the camera type panorama"),
              std::string::npos)
        << error.what();
  }
}

TEST(ScanLine, ExplainsMissingShadows) {
  const auto scene =
      load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}, {'type': 'plane', "
                           "'point': [0, -1, 0], 'normal': [0, 1, 0]}]"),
                      json("{'lights': [{'type': 'point', 'position': [0, 3, 0]}]}")));
  const Plan plan = make_plan(*scene, by("phong"));
  EXPECT_FALSE(plan.shadows);
  const auto shadows = std::find_if(plan.decisions.begin(), plan.decisions.end(),
                                    [](const Decision& decision) { return decision.subject == "shadows"; });
  ASSERT_NE(shadows, plan.decisions.end());
  EXPECT_EQ(shadows->choice, "none");
  EXPECT_EQ(render(scene, by("phong")).stats.counts.rays.total(), kSide * kSide);
}

TEST(ScanLine, ReportsNumberOfTriangles) {
  const Json scene = scene_with(json("{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 1]}"));
  const AcceleratorFacts facts = render(scene, by("flat")).stats.structure;
  EXPECT_EQ(facts.references, 12u);
  EXPECT_GE(facts.bytes, 8 * sizeof(Tessellation::Vertex) + 12 * sizeof(Tessellation::Triangle));
}

}  // namespace
}  // namespace orrery::test
