#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

#include "tests/support/pictures.h"

// Measures the known faults of polygon shading on the scenes scenes/polygon-*.json, against ray casting. The
// rows that the test prints form the table of docs/polygon-faults.md.
namespace orrery::test {
namespace {

// Green channel of an image as displayed, in codes from 0 to 255.
struct Shown {
  int width, height;
  std::vector<double> codes;

  double at(int x, int y) const { return codes[static_cast<std::size_t>(y * width + x)]; }
  bool covered(int x, int y) const { return at(x, y) > kBackground; }
  static constexpr double kBackground = 50;  // the background has code 44
};

Shown show(const Json& scene, const char* technique = nullptr) {
  RenderRequest request;
  if (technique) request.technique = technique;
  const Picture picture = render(scene, request);
  std::vector<double> linear;
  for (const Vec3f& pixel : picture.pixels) linear.push_back(pixel.y);
  Shown out{picture.width, picture.height, shown(std::move(linear))};
  for (double& code : out.codes) code *= 255;
  return out;
}

// Returns the largest change of the slope along the middle rows, from 4 pixels inside the outline, in codes
// per pixel squared.
double largest_bend(const Shown& image) {
  double largest = 0;
  for (int y = image.height / 3; y < image.height * 2 / 3; ++y) {
    int first = 0, last = image.width - 1;
    while (first < last && !image.covered(first, y)) ++first;
    while (first < last && !image.covered(last, y)) --last;
    for (int x = first + 5; x < first + (last - first) * 2 / 3; ++x)
      largest = std::max(largest, std::abs(image.at(x - 1, y) - 2 * image.at(x, y) + image.at(x + 1, y)));
  }
  return largest;
}
double brightest(const Shown& image) { return *std::max_element(image.codes.begin(), image.codes.end()); }
double covered_pixels(const Shown& image) {
  return static_cast<double>(std::count_if(image.codes.begin(), image.codes.end(),
                                           [](double code) { return code > Shown::kBackground; }));
}
double row_of_brightest(const Shown& image) {
  return static_cast<double>(
      (std::max_element(image.codes.begin(), image.codes.end()) - image.codes.begin()) / image.width);
}
double largest_asymmetry(const Shown& image) {
  double largest = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width / 2; ++x)
      if (image.covered(x, y) && image.covered(image.width - 1 - x, y))
        largest = std::max(largest, std::abs(image.at(x, y) - image.at(image.width - 1 - x, y)));
  return largest;
}
// Returns the number of background pixels with the object on both sides in their row.
double pixels_of_cracks(const Shown& image) {
  double count = 0;
  for (int y = 0; y < image.height; ++y) {
    int first = 0, last = image.width - 1;
    while (first < last && !image.covered(first, y)) ++first;
    while (first < last && !image.covered(last, y)) --last;
    for (int x = first; x < last; ++x) count += !image.covered(x, y);
  }
  return count;
}
// Returns the range of codes in the middle fifth of the middle row.
double contrast(const Shown& image) {
  double low = 255, high = 0;
  for (int x = image.width * 2 / 5; x < image.width * 3 / 5; ++x) {
    low = std::min(low, image.at(x, image.height / 2));
    high = std::max(high, image.at(x, image.height / 2));
  }
  return high - low;
}

struct Fault {
  const char *name, *file, *figure, *unit;
  double (*measure)(const Shown&);
  std::function<void(Json& scene)> truth;  // changes the scene before ray casting; may be null
  const char* remedy;
  std::function<void(Json& scene)> mend;  // changes the scene to that without the fault
  double least_rms, largest_rms;  // limits of RMS differences of the image and the mended image, in codes
};

void split_at_vertex(Json& scene) {
  scene["objects"][0]["indices"] = {{0, 1, 4}, {0, 4, 3}, {4, 2, 3}, {1, 5, 4},
                                    {5, 6, 4}, {4, 6, 2}, {6, 7, 2}};
}
void use_normals_of_folds(Json& scene) { scene["objects"][0]["crease_degrees"] = 30; }
std::function<void(Json&)> option(const char* key, const Json& value) {
  return [=](Json& scene) { scene["render"][key] = value; };
}

const Fault kFaults[] = {
    {"Mach bands",
     "mach-bands",
     "largest bend of the brightness along a row",
     "codes/pixel²",
     largest_bend,
     {},
     "`phong`, or `tessellation_error` 0.01",
     option("tessellation_error", 0.01),
     1,
     0.2},
    {"Lost highlight",
     "lost-highlight",
     "brightest pixel",
     "codes",
     brightest,
     {},
     "`phong`",
     option("technique", "phong"),
     10,
     0.01},
    {"Silhouette",
     "silhouette",
     "covered area",
     "pixels",
     covered_pixels,
     {},
     "`tessellation_error` 0.02",
     option("tessellation_error", 0.02),
     5,
     1},
    {"Perspective distortion",
     "perspective",
     "row of the brightest pixel",
     "pixels",
     row_of_brightest,
     {},
     "`interpolation`: `perspective`",
     option("interpolation", "perspective"),
     10,
     0.01},
    {"Orientation dependence",
     "orientation",
     "largest difference of two mirrored squares",
     "codes",
     largest_asymmetry,
     {},
     "`phong`",
     option("technique", "phong"),
     5,
     0.01},
    {"T-vertices", "t-vertices", "area of the crack", "pixels", pixels_of_cracks, split_at_vertex,
     "an edge through the vertex", split_at_vertex, 5, 1},
    {"Unrepresentative normals", "normals", "contrast of the folds", "codes", contrast, use_normals_of_folds,
     "`crease_degrees` 30", use_normals_of_folds, 5, 1},
};

double rms(const Shown& a, const Shown& b) { return rms_difference(a.codes, b.codes); }

// Formats a figure with three digits, and as 0 below 0.005.
std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 100 ? "%.0f" : "%.3g", value < 0.005 ? 0 : value);
  return text;
}

std::string row_of(const Fault& fault) {
  const Json scene = sample(std::string("polygon-") + fault.file);
  Json exact = scene, mended = scene;
  if (fault.truth) fault.truth(exact);
  fault.mend(mended);
  const Shown shown = show(scene), truth = show(exact, "raycast"), without = show(mended);
  const double off = rms(shown, truth), left = rms(without, truth);
  EXPECT_GE(off, fault.least_rms) << fault.name;
  EXPECT_LE(left, fault.largest_rms) << fault.name;
  const std::string columns[] = {
      fault.name,
      std::string("[") + fault.file + "](../scenes/polygon-" + fault.file + ".json)",
      std::string(fault.figure) + ", " + fault.unit,
      figure(fault.measure(shown)),
      figure(fault.measure(truth)),
      figure(off),
      fault.remedy,
      figure(fault.measure(without)),
      figure(left)};
  std::string row = "|";
  for (const std::string& column : columns) row += " " + column + " |";
  return row;
}

// Colours interpolated in triangles turn with the image. Bilinear interpolation along scan lines would not.
TEST(PolygonFaults, InterpolatesIndependentlyOfImageRotation) {
  Json scene = sample("polygon-orientation");
  scene["image"] = {{"width", 200}, {"height", 200}};
  const Shown upright = show(scene);
  scene["camera"]["up"] = {1, 0, 0};  // the right side is now at the top
  const Shown turned = show(scene);
  double largest = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (upright.covered(x, y) && turned.covered(y, 199 - x))
        largest = std::max(largest, std::abs(upright.at(x, y) - turned.at(y, 199 - x)));
  EXPECT_LT(largest, 1e-3);
}

TEST(PolygonFaults, MatchesTableOfDocumentation) {
  std::ifstream file("docs/polygon-faults.md");
  const std::string documentation{std::istreambuf_iterator<char>(file), {}};
  for (const Fault& fault : kFaults) {
    const std::string row = row_of(fault);
    std::printf("%s\n", row.c_str());
    EXPECT_NE(documentation.find(row), std::string::npos) << fault.name;
  }
}

}  // namespace
}  // namespace orrery::test
