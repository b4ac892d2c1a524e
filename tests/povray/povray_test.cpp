#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/load/asset_files.h"
#include "core/load/load.h"
#include "core/plan/plan.h"
#include "tests/povray/picture.h"
#include "tests/povray/povray_program.h"
#include "tests/povray/povray_scene.h"

// Compares Orrery with POV-Ray 3.7 on the same scenes, with one sample per pixel, in linear light. Each run
// writes ours.png, povray.png and difference.png (8 times the difference, excluded pixels in blue) to
// build/povray/<scene>/.
namespace orrery {
namespace {

constexpr double kLargestRms = 0.0002;  // 10 times the quantization error of 16 bits over 0 to 4
constexpr double kMaxOmitted = 0.02;

// Scene in Orrery's format and optionally in POV-Ray's.
struct Case {
  const char* name;
  const char* file;
  RenderRequest request = {};
  const char* povray_file = nullptr;  // hand-written, with an image clamped at 1. nullptr: exported
  double max_rms = kLargestRms;

  float brightest() const { return povray_file ? 1 : 4; }  // clamp of both images
};

RenderRequest side_request(int side) {
  RenderRequest request;
  request.width = request.height = side;
  return request;
}

RenderRequest depth_request(int max_depth) {
  RenderRequest request;
  request.max_depth = max_depth;
  return request;
}

// Known difference: POV-Ray ignores hits within 0.001 of a ray's origin. Therefore bodies do not touch, and a
// few rays through the edges of a glass box differ (glass, filter).
const Case kCases[] = {
    {"paper", "scenes/paper.json", side_request(300)},
    {"paper_of_the_benchmark", "scenes/paper.json", side_request(300), "tests/bench/paper.pov"},
    {"many_lights", "tests/povray/scenes/many_lights.json"},
    {"attenuation", "tests/povray/scenes/attenuation.json"},
    {"spots", "tests/povray/scenes/spots.json"},
    {"highlights", "tests/povray/scenes/highlights.json"},
    {"glass", "tests/povray/scenes/glass.json"},
    {"filter", "tests/povray/scenes/filter.json"},
    {"transparency", "tests/povray/scenes/transparency.json"},
    // POV-Ray omits the Fresnel reflection of rays that enter a body inside another body: a plate of glass
    // around air transmits 0.8889 instead of 0.8571.
    {"nested_media", "tests/povray/scenes/nested_media.json", {}, nullptr, 0.004},
    // POV-Ray shows the plane of each triangle along the terminator of smooth meshes.
    {"mesh", "tests/povray/scenes/mesh.json", {}, nullptr, 0.0015},
    {"corridor", "tests/povray/scenes/corridor.json"},
    {"corridor_of_depth_2", "tests/povray/scenes/corridor.json", depth_request(2)},
    {"solids", "tests/povray/scenes/solids.json"},
    {"cones", "tests/povray/scenes/cones.json"},
    {"tori", "tests/povray/scenes/tori.json"},
    {"fog", "tests/povray/scenes/fog.json"},
    {"checkers", "tests/povray/scenes/checkers.json"},
    {"images", "tests/povray/scenes/images.json"},
    {"ellipsoids", "tests/povray/scenes/ellipsoids.json"},
    {"patches", "tests/povray/scenes/patches.json"},
    {"orthographic", "tests/povray/scenes/orthographic.json"},
};

// A pixel is an edge if one of four samples around its centre differs from the sample at the centre by more
// than kEdgeContrast. At an edge, a rounding error can move an outline, a reflection or a shadow across the
// centre. Smooth surfaces change much less over this distance.
constexpr float kEdgeDistance = 0.03f;  // pixels
constexpr float kEdgeContrast = 0.02f;

// Returns true for each excluded pixel: edges, and pixels that the two programs define differently.
std::vector<bool> pixels_left_out(const PreparedScene& scene, const Plan& plan, float brightest) {
  const Samples centre = render_shifted(scene, plan, 0, 0);
  // At an outline, the interpolated normal of a mesh may face away from the viewer. POV-Ray flips the normal.
  // Orrery keeps it on the visible side of the triangle.
  std::vector<bool> out = normals_facing_away(scene, plan);
  for (const float dx : {-kEdgeDistance, kEdgeDistance})
    for (const float dy : {-kEdgeDistance, kEdgeDistance}) {
      const Picture shifted = render_shifted(scene, plan, dx, dy).picture;
      for (std::size_t i = 0; i < out.size(); ++i)
        if (difference(shifted.pixels[i], centre.picture.pixels[i], brightest) > kEdgeContrast) out[i] = true;
    }
  // A ray beyond max_depth returns ambient light in Orrery, and black in POV-Ray.
  if (scene.scene().ambient != Vec3d(0))
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = out[i] || centre.cut[i];
  return out;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Picture povray_picture(const Case& c, const std::string& json, const Plan& plan, const std::string& folder) {
  const PovrayOptions options{.aspect = static_cast<double>(plan.width) / plan.height,
                              .max_depth = plan.max_depth,
                              .exposure = 1 / static_cast<double>(c.brightest())};
  std::ofstream(folder + "/povray.pov")
      << (c.povray_file ? read_file(c.povray_file) : povray_scene(nlohmann::json::parse(json), options));
  Picture picture = run_povray(folder, plan.width, plan.height);
  for (Vec3f& pixel : picture.pixels) pixel = pixel * c.brightest();
  return picture;
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.file; }

class Povray : public testing::TestWithParam<Case> {};

TEST_P(Povray, RendersSameImage) {
  if (!povray_is_installed()) GTEST_SKIP() << "povray is not installed";
  const Case& c = GetParam();
  const std::string folder = std::string("build/povray/") + c.name;
  std::filesystem::create_directories(folder);
  const std::string json = read_file(c.file);
  const PreparedScene scene(load_scene(json, AssetFiles(std::filesystem::path(c.file).parent_path())));
  const Plan plan = make_plan(scene.scene(), c.request);

  const Picture ours = render_picture(scene, plan);
  const Picture theirs = povray_picture(c, json, plan, folder);
  const std::vector<bool> left_out = pixels_left_out(scene, plan, c.brightest());
  const Comparison result = compare(ours, theirs, left_out, c.brightest());
  write_png(ours, folder + "/ours.png");
  write_png(theirs, folder + "/povray.png");
  write_png(difference_picture(ours, theirs, left_out, c.brightest(), 8), folder + "/difference.png");

  std::printf("%-22s RMS %.6f (all pixels %.6f), %.2f %% excluded, largest %.4f at (%d, %d)\n", c.name,
              result.rms, result.rms_of_all, 100 * result.left_out, result.largest, result.largest_x,
              result.largest_y);
  EXPECT_LE(result.rms, c.max_rms);
  EXPECT_LE(result.left_out, kMaxOmitted);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Povray, testing::ValuesIn(kCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace orrery
