#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/load/load.h"
#include "core/plan/plan.h"
#include "tests/povray/picture.h"
#include "tests/povray/povray_program.h"
#include "tests/povray/povray_scene.h"

// POV-Ray 3.7 as an oracle: the same scenes, rendered by both, one sample a pixel, as linear light. Each run leaves
// ours.png, povray.png and difference.png (8 times; edges blue) in build/povray/<scene>/ to look at.
namespace orrery {
namespace {

constexpr float kBrightest = 4;  // what both pictures end at

// POV-Ray's 16 bits alone make an RMS of 4 / 65536 / sqrt(12) = 0.00002.
constexpr double kLargestRms = 0.0002;
constexpr double kLargestEdgeShare = 0.12;

struct Case {
  const char* name;
  const char* file;
  RenderRequest request = {};
};

RenderRequest paper_request() {
  RenderRequest request;
  request.width = request.height = 300;
  request.max_depth = 30;  // a ray too deep is ambient light to us and black to POV-Ray: let there be none
  return request;
}

RenderRequest depth_request(int max_depth) {
  RenderRequest request;
  request.max_depth = max_depth;
  return request;
}

const Case kCases[] = {
    {"paper", "scenes/paper.json", paper_request()},
    {"many_lights", "tests/povray/scenes/many_lights.json"},
    {"attenuation", "tests/povray/scenes/attenuation.json"},
    {"spots", "tests/povray/scenes/spots.json"},
    {"highlights", "tests/povray/scenes/highlights.json"},
    {"glass", "tests/povray/scenes/glass.json"},
    {"filter", "tests/povray/scenes/filter.json"},
    {"mesh", "tests/povray/scenes/mesh.json"},
    {"corridor", "tests/povray/scenes/corridor.json"},
    {"corridor_depth_2", "tests/povray/scenes/corridor.json", depth_request(2)},
    {"solids", "tests/povray/scenes/solids.json"},
    {"orthographic", "tests/povray/scenes/orthographic.json"},
};

// A pixel is an edge if our picture jumps within it: where one of four samples around its centre differs from
// that at the centre. There a difference in the last digits moves an outline, or its mirror image, or a shadow,
// over the centre. A smooth surface changes far less over so small a distance.
constexpr float kEdgeDistance = 0.03f;  // pixels
constexpr float kEdgeContrast = 0.02f;

// Nor is a pixel compared where a mesh's interpolated normal faces away from the viewer, as it may at an outline:
// POV-Ray turns it round, we keep it on the side of the triangle that is seen.
std::vector<bool> edges_of(const PreparedScene& scene, const Plan& plan) {
  const Picture centre = render_shifted(scene, plan, 0, 0);
  std::vector<bool> edges = normals_facing_away(scene, plan);
  for (const float dx : {-kEdgeDistance, kEdgeDistance})
    for (const float dy : {-kEdgeDistance, kEdgeDistance}) {
      const Picture shifted = render_shifted(scene, plan, dx, dy);
      for (std::size_t i = 0; i < edges.size(); ++i)
        if (difference(shifted.pixels[i], centre.pixels[i], kBrightest) > kEdgeContrast) edges[i] = true;
    }
  return edges;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Picture povray_picture(const std::string& json, const Plan& plan, const std::string& folder) {
  const double aspect = static_cast<double>(plan.width) / plan.height;
  std::ofstream(folder + "/povray.pov") << povray_scene(
      nlohmann::json::parse(json),
      {.aspect = aspect, .max_depth = plan.max_depth, .exposure = 1 / static_cast<double>(kBrightest)});
  Picture picture = run_povray(folder, plan.width, plan.height);
  for (Vec3f& pixel : picture.pixels) pixel = pixel * kBrightest;
  return picture;
}

class Povray : public testing::TestWithParam<Case> {};

TEST_P(Povray, PictureEqualsOurs) {
  if (!povray_is_installed()) GTEST_SKIP() << "povray is not installed";
  const Case& c = GetParam();
  const std::string folder = std::string("build/povray/") + c.name;
  std::filesystem::create_directories(folder);
  const std::string json = read_file(c.file);
  const PreparedScene scene(load_scene(json));
  const Plan plan = make_plan(scene.scene(), c.request);

  const Picture ours = render_picture(scene, plan);
  const Picture theirs = povray_picture(json, plan, folder);
  const std::vector<bool> edges = edges_of(scene, plan);
  const Comparison result = compare(ours, theirs, edges, kBrightest);
  write_png(ours, folder + "/ours.png");
  write_png(theirs, folder + "/povray.png");
  write_png(difference_picture(ours, theirs, edges, kBrightest, 8), folder + "/difference.png");

  std::printf("%-18s RMS %.6f, with edges %.6f; %.2f %% edges; largest %.4f at (%d, %d)\n", c.name, result.rms,
              result.rms_of_all, 100 * result.edge_share, result.largest, result.largest_x, result.largest_y);
  EXPECT_LE(result.rms, kLargestRms);
  EXPECT_LE(result.edge_share, kLargestEdgeShare);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Povray, testing::ValuesIn(kCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace orrery
