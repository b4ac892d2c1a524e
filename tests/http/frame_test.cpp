#include "tests/http/daemon.h"

namespace orrery {
namespace {

class FramePng : public HttpTest {
 protected:
  std::string path(const std::string& query = "") {
    return "/v1/scenes/" + post_scene(small_scene().dump()) + "/frame.png" + query;
  }
};

TEST_F(FramePng, ReturnsImmutablePng) {
  const auto result = client_.Get(path("?azimuth=30&width=40&height=30"));
  ASSERT_TRUE(result);
  ASSERT_EQ(result->status, 200) << result->body;
  EXPECT_TRUE(is_png(result->body));
  EXPECT_EQ(result->body.substr(16, 8), std::string("\0\0\0\x28\0\0\0\x1e", 8));  // width and height
  EXPECT_EQ(result->get_header_value("Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_FALSE(result->get_header_value("Orrery-Rays").empty());
}

TEST_F(FramePng, ReturnsEqualBytesForEqualUrls) {
  const auto first = client_.Get(path("?azimuth=75&samples=4"));
  const auto second = client_.Get(path("?azimuth=75&samples=4"));
  EXPECT_EQ(first->body, second->body);
  EXPECT_NE(first->body, client_.Get(path("?azimuth=76&samples=4"))->body);
}

TEST_F(FramePng, ReturnsSameETagForEquivalentQueries) {
  const auto etag = [&](const std::string& query) {
    return client_.Head(path(query))->get_header_value("ETag");
  };
  const std::string plain = etag("");
  EXPECT_EQ(plain.front(), '"');
  EXPECT_EQ(etag("?width=48&azimuth=0.0"), plain);
  EXPECT_EQ(etag("?azimuth=-0"), plain);
  EXPECT_EQ(etag("?technique=whitted&height=32"), plain);
  EXPECT_EQ(etag("?accelerator=octree&reorder=true&prediction=last"), plain);
  for (const char* query :
       {"?azimuth=1", "?elevation=1", "?distance=2", "?pan=1,0,0", "?fov=46", "?width=49",
        "?azimuth_degrees=1", "?depth=1", "?height=33", "?samples=2", "?technique=raycast", "?max_depth=1",
        "?min_contribution=0.5", "?seed=1", "?precision=double"})
    EXPECT_NE(etag(query), plain) << query;
}

TEST_F(FramePng, IncludesTimeInETagOfMovingScene) {
  const auto tag = [&](const nlohmann::json& scene, const std::string& query) {
    const std::string path = "/v1/scenes/" + post_scene(scene.dump()) + "/frame.png";
    return client_.Head(path + query)->get_header_value("ETag");
  };
  EXPECT_EQ(tag(small_scene(), ""), tag(small_scene(), "?time=1"));
  EXPECT_NE(tag(moving_scene(), ""), tag(moving_scene(), "?time=1"));
  EXPECT_EQ(tag(moving_scene(), "?time=2"), tag(moving_scene(), "?time=3"));
}

TEST_F(FramePng, ReturnsNotModifiedForKnownImage) {
  const auto first = client_.Get(path());
  const std::string etag = first->get_header_value("ETag");
  for (const std::string& known : {etag, "\"x\", " + etag, std::string("*")}) {
    const auto again = get_known(path(), known);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->status, 304) << known;
    EXPECT_TRUE(again->body.empty());
    EXPECT_FALSE(again->has_header("Orrery-Rays"));
    EXPECT_FALSE(again->has_header("Content-Length"));
    EXPECT_EQ(again->get_header_value("ETag"), etag);
  }
  EXPECT_EQ(get_known(path(), "\"other\"")->status, 200);
}

TEST_F(FramePng, DoesNotRenderForHead) {
  const auto head = client_.Head(path("?width=4096&height=4096&samples=4096"));  // would take hours
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Type"), "image/png");
  EXPECT_FALSE(head->has_header("Orrery-Rays"));
}

TEST_F(FramePng, ReportsInvalidQueryParameters) {
  const auto pointer_for = [&](const std::string& query, int status = 422) {
    const auto problem = expect_problem(client_.Get(path(query)), status);
    return problem.contains("errors") ? problem["errors"][0].value("pointer", "?") : "";
  };
  EXPECT_EQ(pointer_for("?azimuth=1abc"), "/azimuth");
  EXPECT_EQ(pointer_for("?azimuth=nan"), "/azimuth");
  EXPECT_EQ(pointer_for("?pan=1"), "/pan");
  EXPECT_EQ(pointer_for("?pan=1,2,3,4"), "/pan");
  EXPECT_EQ(pointer_for("?pan=1,x,3"), "/pan/1");
  EXPECT_EQ(pointer_for("?pan=1,,3"), "/pan/1");
  EXPECT_EQ(pointer_for("?pan=1,2,1e13"), "/pan/2");
  EXPECT_EQ(pointer_for("?azimuth=1,2"), "/azimuth");
  EXPECT_EQ(pointer_for("?azimuth=inf"), "/azimuth");
  EXPECT_EQ(pointer_for("?azimuth=1e999"), "/azimuth");
  EXPECT_EQ(pointer_for("?azimuth="), "/azimuth");
  EXPECT_EQ(pointer_for("?width=4097"), "/width");
  EXPECT_EQ(pointer_for("?width=10.5"), "/width");
  EXPECT_EQ(pointer_for("?distance=0"), "/distance");
  EXPECT_EQ(pointer_for("?fov=180"), "/fov");
  EXPECT_EQ(pointer_for("?accelerator=tree"), "/accelerator");
  EXPECT_EQ(pointer_for("?frames=3"), "/frames");
  EXPECT_EQ(pointer_for("?azimuth=1&azimuth=2", 400), "");
  EXPECT_EQ(pointer_for("?azimuth=%zz", 400), "");
  EXPECT_EQ(pointer_for("?azimuth=%ff", 400), "");
  EXPECT_EQ(pointer_for("?fov_degrees=180"), "/fov_degrees");
  EXPECT_EQ(pointer_for("?azimuth=1&azimuth_degrees=1"), "/azimuth_degrees");
  const auto detail_for = [&](const std::string& query) {
    return expect_problem(client_.Get(path(query)), 422).at("detail").get<std::string>();
  };
  EXPECT_NE(detail_for("?azimut=1").find("did you mean \"azimuth\""), std::string::npos);
  EXPECT_NE(detail_for("?w=100").find("did you mean \"width\""), std::string::npos);
  EXPECT_NE(detail_for("?azimuth_degree=1").find("did you mean \"azimuth_degrees\""), std::string::npos);
  EXPECT_NE(detail_for("?azimuth=1&azimuth_degrees=1").find("cannot be used with \"azimuth\""),
            std::string::npos);
}

}  // namespace
}  // namespace orrery
