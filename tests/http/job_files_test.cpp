#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "server/http/response_quota.h"
#include "server/http/target.h"
#include "server/routes/routes.h"
#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

// Tests responses that contain files of jobs.
namespace orrery {
namespace {

class JobFiles : public testing::Test {
 protected:
  JobFiles() { add_routes(router_, app_); }
  Response answer(const std::string& method, const std::string& path, std::string body = {}) {
    Request request;
    request.method = method;
    Target target = parse_target(path);
    request.path = std::move(target.path);
    request.segments = std::move(target.segments);
    request.body = Body(std::move(body));
    request.client = "somebody";
    return router_.find(request).handler(request);
  }
  static nlohmann::json json_of(const Response& response) {
    return nlohmann::json::parse(std::string_view(response.body));
  }

  SteadyTimer timer_;
  App app_{Settings(), timer_};
  Router router_;
};

TEST_F(JobFiles, SharesBytesBetweenReaders) {
  const nlohmann::json order = {{"scene", small_scene()}, {"image", {{"width", 1200}, {"height", 900}}}};
  const std::string job = job_path(json_of(answer("POST", "/v1/jobs", order.dump())));
  EXPECT_TRUE(test::eventually([&] { return json_of(answer("GET", job)).at("state") == "done"; }));
  ResponseQuota budget(200'000);
  std::vector<ResponseQuota::Share> shares;
  std::set<const char*> places;
  for (int reader = 0; reader < 100; ++reader) {
    const Response response = answer("GET", job + "/frames/0.png");
    EXPECT_EQ(response.status, 200);
    EXPECT_GT(response.body.size(), 70'000U) << "smaller responses are exempt from the quota";
    places.insert(response.body.data());
    shares.push_back(budget.take(response.body, "reader " + std::to_string(reader)));
  }
  EXPECT_EQ(places.size(), 1U);
}

TEST_F(JobFiles, OutlivesDeletedJob) {
  const nlohmann::json order = {{"scene", small_scene()}};
  const std::string job = job_path(json_of(answer("POST", "/v1/jobs", order.dump())));
  EXPECT_TRUE(test::eventually([&] { return json_of(answer("GET", job)).at("state") == "done"; }));
  const Response response = answer("GET", job + "/frames/0.png");
  const std::string copy{std::string_view(response.body)};
  EXPECT_EQ(answer("DELETE", job).status, 204);
  EXPECT_EQ(std::string_view(response.body), copy);
  EXPECT_TRUE(is_png(copy));
}

}  // namespace
}  // namespace orrery
