#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "core/load/load.h"

// Compares the loader with the corpus. expectations.json contains the JSON pointer of the first problem in
// each bad scene. schema.test.mjs compares the schema with the same files, so schema and loader agree.

namespace orrery {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = "tests/schema";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return (std::stringstream() << in.rdbuf()).str();
}

std::vector<fs::path> scenes_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty()) << folder;
  return files;
}

TEST(Corpus, LoadsGoodScenes) {
  for (const fs::path& folder : {kCorpus / "good", fs::path("scenes")}) {
    for (const fs::path& file : scenes_in(folder)) {
      EXPECT_NO_THROW(load_scene(text_of(file))) << file;
    }
  }
}

TEST(Corpus, RejectsBadScenesAtExpectedPath) {
  const auto expectations = nlohmann::json::parse(text_of(kCorpus / "expectations.json"));
  std::size_t seen = 0;
  for (const fs::path& file : scenes_in(kCorpus / "bad")) {
    const std::string name = file.stem();
    ASSERT_TRUE(expectations.contains(name)) << name;
    ++seen;
    try {
      load_scene(text_of(file));
      ADD_FAILURE() << "accepted: " << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().front().pointer, expectations[name]["pointer"])
          << name << ": " << error.what();
      EXPECT_FALSE(error.problems().front().detail.empty()) << name;
    }
  }
  EXPECT_EQ(seen, expectations.size());
}

TEST(Corpus, ReportsOneProblemPerMistake) {
  for (const char* name :
       {"sphere-radius-negative", "camera-up-zero", "material-type-unknown", "light-type-unknown",
        "object-type-unknown", "camera-type-unknown", "mesh-index-too-large", "cylinder-of-neither-form",
        "cylinder-of-both-forms", "camera-eye-missing", "triangle-of-two", "image-is-null"}) {
    try {
      load_scene(text_of(kCorpus / "bad" / (std::string(name) + ".json")));
      ADD_FAILURE() << "accepted: " << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().size(), 1u)
          << name << ": " << error.problems()[1].pointer << ": " << error.problems()[1].detail;
    }
  }
}

TEST(Schema, MatchesCheckedInFile) {
  EXPECT_EQ(text_of("scenes/schema/scene.json"), scene_schema())
      << "renew it: orrery schema > scenes/schema/scene.json";
}

}  // namespace
}  // namespace orrery
