#include "server/api/results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

// Tests the table of the results of an image.
namespace orrery {
namespace {

struct Sample {
  RenderStats stats;
  Certificate certificate{.terms = {{"samples", Bound::unknown(), "test"}},
                          .biases = {{"clamp_indirect", 1, {-1, 0, 0}, {0.5, 0, 0}}}};
  std::vector<Problem> warnings{{"/lights", "none"}};

  ImageResults results() const {
    return {.stats = &stats, .certificate = &certificate, .warnings = warnings, .samples = 4, .rays = 7};
  }
};

std::set<std::string> names_of(const Fields& fields) {
  std::set<std::string> names;
  for (const auto& field : fields) names.insert(field.first);
  return names;
}

using Names = std::set<std::string>;

TEST(Results, SelectsHeadersByOutput) {
  const Sample sample;
  EXPECT_EQ(
      names_of(result_headers(&ResultOutputs::image, sample.results())),
      (Names{"Orrery-Rays", "X-Rays", "Orrery-Error-Bound", "Orrery-Bias", "X-Bias", "Orrery-Warning"}));
  EXPECT_EQ(names_of(result_headers(&ResultOutputs::refinement_part, sample.results())),
            (Names{"Orrery-Samples", "X-Samples", "Orrery-Rays", "X-Rays", "Orrery-Error-Bound",
                   "Orrery-Bias", "X-Bias"}));
  EXPECT_EQ(names_of(result_headers(&ResultOutputs::orbit_part, sample.results())),
            (Names{"Orrery-Error-Bound"}));
  EXPECT_TRUE(result_headers(&ResultOutputs::image, {}).empty());
}

TEST(Results, SelectsMembersByOutput) {
  const Sample sample;
  const auto frame = result_members(&ResultOutputs::refinement_frame, sample.results());
  EXPECT_EQ(frame.at("samples"), 4);
  EXPECT_EQ(frame.at("rays"), 7);
  EXPECT_TRUE(frame.at("bound").contains("terms"));
  EXPECT_FALSE(frame.contains("error"));
  const auto step = result_members(&ResultOutputs::job_step, sample.results());
  EXPECT_EQ(step.size(), 1u);
  EXPECT_EQ(step.at("bound").at("kind"), "unknown");
  EXPECT_EQ(step.at("bound").at("space"), "linear");
}

TEST(Results, NamesAllHeadersOfAnOutput) {
  const Sample sample;
  const auto names = result_header_names(&ResultOutputs::image);
  for (const auto& [name, value] : result_headers(&ResultOutputs::image, sample.results()))
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  EXPECT_EQ(std::count(names.begin(), names.end(), "Orrery-RMSE"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "Orrery-Samples"), 0);
}

TEST(Results, DescribesHeadersAndStreamMembers) {
  for (const ImageResult& row : image_results()) {
    EXPECT_TRUE(row.header.empty() || row.text || row.json) << row.header;
    EXPECT_EQ(row.member.empty(), row.json == nullptr) << row.member;
    const bool in_streams = row.in.refinement_frame || row.in.orbit_frame || row.in.job_step;
    if (row.header.empty() && !in_streams) continue;
    EXPECT_FALSE(row.description.empty()) << row.header << row.member;
    EXPECT_FALSE(row.description.ends_with('.')) << row.description;
    EXPECT_EQ(row.member.empty(), row.member_type.empty()) << row.member;
  }
}

}  // namespace
}  // namespace orrery
