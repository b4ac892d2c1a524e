#include <numeric>

#include "tests/http/daemon.h"

namespace orrery {
namespace {

const httplib::Headers kFrames{{"Accept", "application/x-orrery-frames"}};

class RefinementStream : public HttpTest {
 protected:
  const std::string scene_ = "/v1/scenes/" + post_scene(small_scene().dump());

  // Returns the query of a view that no other test requests.
  static std::string view(int azimuth, int samples) {
    return "azimuth=" + std::to_string(azimuth) + "&samples=" + std::to_string(samples);
  }
  std::vector<StreamedFrame> refine(const std::string& query) {
    const auto result = client_.Get(scene_ + "/refinement?" + query, kFrames);
    return result && result->status == 200 ? parse_frames(result->body) : std::vector<StreamedFrame>{};
  }
  static std::vector<int> samples_of(const std::vector<StreamedFrame>& frames) {
    std::vector<int> samples;
    for (const auto& frame : frames) samples.push_back(frame.header.at("samples"));
    return samples;
  }
  static std::uint64_t rays_of(const std::vector<StreamedFrame>& frames) {
    return std::accumulate(frames.begin(), frames.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& f) {
                             return sum + f.header.at("rays").template get<std::uint64_t>();
                           });
  }
};

TEST_F(RefinementStream, DoublesSamplesInEachPass) {
  EXPECT_EQ(samples_of(refine(view(1, 64) + "&technique=path")), (std::vector{1, 2, 4, 8, 16, 32, 64}));
  EXPECT_EQ(samples_of(refine(view(1, 12) + "&technique=path")), (std::vector{1, 3, 6, 12}));
  // A single sample of this technique is at the pixel centre and not part of a longer sequence.
  EXPECT_EQ(samples_of(refine(view(1, 8))), (std::vector{2, 4, 8}));
  EXPECT_EQ(samples_of(refine(view(1, 1))), (std::vector{1}));
}

// Another daemon renders each image, because this one would return it from its cache.
TEST_F(RefinementStream, MatchesImageOfEachSampleCount) {
  Daemon other;
  httplib::Client client = other.client();
  client.Post("/v1/scenes", small_scene().dump(), "application/json");
  for (const std::string more : {"", "&technique=path", "&technique=path&filter=mitchell"}) {
    const auto frames = refine("azimuth=2&samples=24" + more);
    ASSERT_GE(frames.size(), 4u) << more;
    for (const StreamedFrame& frame : frames) {
      const std::string samples = std::to_string(frame.header.at("samples").get<int>());
      const auto whole = client.Get(scene_ + "/frame.png?azimuth=2&samples=" + samples + more);
      ASSERT_TRUE(whole->has_header("Orrery-Rays"));
      EXPECT_EQ(whole->body, frame.png) << samples << more;
      const std::string told = whole->get_header_value("Orrery-RMSE");
      EXPECT_EQ(told.empty(), !frame.header.contains("error")) << samples;
      if (told.empty()) continue;
      const auto& error = frame.header.at("error");
      EXPECT_NEAR(std::stod(told), error.at("rmse"), 1e-3 * std::stod(told));
      EXPECT_NE(told.find("; samples=" + samples + "; rays="), std::string::npos) << told;
      EXPECT_EQ(error.at("samples"), frame.header.at("samples"));
      for (const char* key : {"rmse_low", "rmse_high", "rmse_4", "rmse_32", "rays"})
        EXPECT_TRUE(error.contains(key)) << key;
    }
  }
}

TEST_F(RefinementStream, TracesEachSampleOnce) {
  const double before = daemon().metric("orrery_rays_total");
  const auto frames = refine(view(3, 64));
  const double traced = daemon().metric("orrery_rays_total") - before;
  EXPECT_EQ(static_cast<double>(rays_of(frames)), traced);
  Daemon other;
  httplib::Client client = other.client();
  client.Post("/v1/scenes", small_scene().dump(), "application/json");
  const auto whole = client.Get(scene_ + "/frame.png?" + view(3, 64));
  EXPECT_EQ(std::to_string(rays_of(frames)), whole->get_header_value("Orrery-Rays"));
}

TEST_F(RefinementStream, EndsAtOnceIfImageIsCached) {
  ASSERT_GT(refine(view(4, 16)).size(), 1u);
  const double before = daemon().metric("orrery_rays_total");
  const auto again = refine(view(4, 16));
  EXPECT_EQ(samples_of(again), (std::vector{16}));
  EXPECT_EQ(again.at(0).header.at("rays"), 0);
  EXPECT_GT(again.at(0).header.at("error").at("rays"), 0);
  const auto part = client_.Get(scene_ + "/frame.png?" + view(4, 8));  // images of passes are also cached
  EXPECT_FALSE(part->has_header("Orrery-Rays"));
  EXPECT_EQ(daemon().metric("orrery_rays_total"), before);
}

TEST_F(RefinementStream, SendsMultipartWithErrorsToBrowsers) {
  const auto result = client_.Get(scene_ + "/refinement?" + view(5, 4), {{"Accept", "image/*,*/*;q=0.8"}});
  ASSERT_EQ(result->get_header_value("Content-Type").substr(0, 27), "multipart/x-mixed-replace; ");
  for (const char* text :
       {"Orrery-Samples: 2\r\n", "Orrery-Samples: 4\r\n", "Orrery-RMSE: ", "Orrery-Rays: "})
    EXPECT_NE(result->body.find(text), std::string::npos) << text;
  EXPECT_TRUE(result->body.ends_with("--\r\n"));
}

TEST_F(RefinementStream, RejectsInvalidRequestsBeforeStreaming) {
  for (const char* query : {"samples=0", "width=0", "frames=3", "layers=depth"})
    expect_problem(client_.Get(scene_ + "/refinement?" + query, kFrames), 422);
  expect_problem(client_.Get(scene_ + "/refinement", {{"Accept", "text/html"}}), 406);
  expect_problem(client_.Get("/v1/scenes/nosuch/refinement"), 404);
  const auto endless = client_.Get(scene_ + "/refinement?width=4096&height=4096&samples=4096", kFrames);
  EXPECT_NE(expect_problem(endless, 422).at("detail").get<std::string>().find("request_rays"),
            std::string::npos);
  EXPECT_EQ(client_.Head(scene_ + "/refinement?width=4096&height=4096&samples=4096")->status, 200);
  EXPECT_TRUE(daemon().wait_until_idle());
}

TEST(RefinementMemory, CountsAgainstMemoryLimitOfClient) {
  Daemon daemon({"--memory-bytes", "400000000"});
  httplib::Client client = daemon.client();
  const auto posted = client.Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  const auto refused = client.Get("/v1/scenes/" + id + "/refinement?width=4096&height=4096&samples=2",
                                  kFrames);  // 402 MB of sums
  EXPECT_NE(expect_problem(refused, 422).at("detail").get<std::string>().find("work_bytes"),
            std::string::npos);
}

}  // namespace
}  // namespace orrery
