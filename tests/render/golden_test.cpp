#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/image/encode/files.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Compares images with tests/golden/<scene>.png, byte by byte. After an intended change,
//   ORRERY_UPDATE_GOLDEN=1 script/test render
// rewrites the files. Look at each changed image before you commit it.
namespace orrery::test {
namespace {

namespace fs = std::filesystem;

Image picture_of(const std::string& name) {
  const auto scene = load(sample(name));
  const PreparedScene prepared(scene);
  RenderRequest request = size(128, 96);
  request.samples = 4;
  request.time = 0.6;  // objects are in motion
  return render_frame(prepared, settle(prepared, make_plan(*scene, request)), FilmStorage::srgb8,
                      shared_executor())
      .film.image(PixelFormat::srgb8);
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, MatchesStoredImage) {
  const fs::path file = fs::path("tests/golden") / (GetParam() + ".png");
  const Image now = picture_of(GetParam());
  if (std::getenv("ORRERY_UPDATE_GOLDEN")) {
    ASSERT_FALSE(std::getenv("CI")) << "stored images must not be replaced in CI";
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << encode_png(now, {.level = 9});
    GTEST_SKIP() << "replaced " << file;
  }
  const std::string bytes = read(file);
  ASSERT_FALSE(bytes.empty()) << "cannot read " << file << ": see the comment in this test";
  const Image then = decode_image(std::as_bytes(std::span(bytes)));
  ASSERT_EQ(then.width(), now.width());
  ASSERT_EQ(then.height(), now.height());
  int differing = 0, largest = 0;
  for (std::size_t i = 0; i < now.bytes().size(); ++i) {
    const int difference = std::abs(static_cast<int>(now.bytes()[i]) - static_cast<int>(then.bytes()[i]));
    differing += difference > 0;
    largest = std::max(largest, difference);
  }
  EXPECT_EQ(differing, 0) << "bytes differ, by up to " << largest;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden,
                         testing::Values("paper", "glass", "mirrors", "light-many", "material-reflective",
                                         "shape-mesh", "shape-infinite-cylinder", "instances", "orrery",
                                         "flag", "technique-distributed"),
                         parameter_name);

}  // namespace
}  // namespace orrery::test
