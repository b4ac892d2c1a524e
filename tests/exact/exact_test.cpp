#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "tests/exact/oracle.h"
#include "tests/exact/random_scenes.h"
#include "tests/support/pictures.h"
#include "tests/support/structures.h"

// Compares the renderer's visibility with exact arithmetic, pixel by pixel. The environment variable
// EXACT_PIXELS sets the number of pixels over all scene classes. Each pixel is compared in float and double.
namespace orrery::test {
namespace {

constexpr int kWidth = 32, kHeight = 24;
constexpr double kMaxRoundings = 4;

int scenes_of_a_class() {
  const char* asked = std::getenv("EXACT_PIXELS");
  const double pixels = asked ? std::atof(asked) : 20000;
  return static_cast<int>(
      std::ceil(pixels / (kWidth * kHeight) / static_cast<double>(scene_classes().size())));
}

std::vector<float> objects_seen(const Json& scene, Precision precision, const std::string& accelerator) {
  RenderRequest request;
  request.precision = precision;
  request.accelerator = accelerator;
  request.technique = "raycast";
  request.layers = std::vector<std::string>{"object"};
  const auto loaded = load(scene);
  const PreparedScene prepared(loaded);
  const Plan plan = make_plan(*loaded, request);
  return render_frame(prepared, settle(prepared, plan), FilmStorage::sums, shared_executor())
      .film.values(0, 0);
}

// Returns the smallest tested number of rounding errors that explains `object` at the pixel. A result above
// kMaxRoundings means that the object is wrong.
double roundings(const exact::Oracle& oracle, int x, int y, int object, double epsilon) {
  double count = 1;
  while (count <= kMaxRoundings && !oracle.explains(x, y, object, count, epsilon)) count *= 2;
  return count;
}

class ExactVisibility : public testing::TestWithParam<SceneClass> {};

TEST_P(ExactVisibility, MatchesOracleUpToRoundingAtEdges) {
  const auto accelerators = accelerator_names();
  std::map<std::string, int> differing;
  int pixels = 0;
  for (int i = 0; i < scenes_of_a_class(); ++i) {
    Random random(static_cast<std::uint64_t>(i));
    Json scene = GetParam().make(random);
    scene["image"] = {{"width", kWidth}, {"height", kHeight}};
    const std::string accelerator =
        accelerators[static_cast<std::size_t>(random.below(static_cast<int>(accelerators.size())))];
    const auto in_float = objects_seen(scene, Precision::single_precision, accelerator);
    const auto in_double = objects_seen(scene, Precision::double_precision, accelerator);
    const exact::Oracle oracle(scene);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y * kWidth + x);
        const int right = oracle.object_at(x, y);
        ++pixels;
        const auto check = [&](const char* type, float seen, double epsilon) {
          if (static_cast<int>(seen) == right) return;
          const double count = roundings(oracle, x, y, static_cast<int>(seen), epsilon);
          ++differing[std::string(type) + " within " + std::to_string(static_cast<int>(count))];
          EXPECT_LE(count, kMaxRoundings)
              << type << " sees object " << seen << " instead of " << right << " at " << x << ", " << y
              << " by " << accelerator << ", scene " << i;
        };
        check("double", in_double[pixel], 0x1p-52);
        check("float", in_float[pixel], 0x1p-23);
      }
  }
  std::cout << GetParam().name << ": " << pixels << " pixels in each number type";
  for (const auto& [kind, count] : differing) std::cout << ", " << count << " " << kind << " roundings";
  std::cout << "\n";
}
INSTANTIATE_TEST_SUITE_P(Classes, ExactVisibility, testing::ValuesIn(scene_classes()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace orrery::test
