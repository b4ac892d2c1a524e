#include <sstream>

#include "tests/http/daemon.h"

// Tests charts of accuracy against speed, measured by the service.
namespace orrery {
namespace {

using nlohmann::json;

constexpr const char* kJson = "application/json";

json ends_on(const std::string& name) {
  return {{"image", {{"width", 16}, {"height", 12}}},
          {"chart", {{"samples", 4}, {"rounds", 2}}},
          {"render", {{"max_depth", 1}, {"technique", name}}}};
}

using Cells = std::vector<std::vector<std::string>>;

// Returns the rows of a CSV table, starting with the header.
Cells cells(const std::string& csv) {
  Cells all;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(line.back(), '\r');
    line.back() = ',';
    all.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) all.back().push_back(cell);
  }
  return all;
}

// Returns the expected table of a chart's points.
Cells cells(const json& points) {
  Cells all(1);
  for (const std::string name :
       {"technique",      "max_depth", "precision", "samples",    "accelerator",  "rounds",        "cpu_ms",
        "times_cheapest", "rays",      "rmse",      "rmse_sd",    "relative_mse", "mean_absolute", "largest",
        "bias",           "psnr_db",   "ssim",      "non_finite", "on_front",     "undecided",     "plan"})
    all.front().push_back(name);
  for (const json& point : points) {
    all.emplace_back();
    for (const std::string& name : all.front()) {
      const json& value = point.at(name);
      all.back().push_back(value.is_null()     ? ""
                           : value.is_string() ? value.get<std::string>()
                                               : value.dump());
    }
  }
  return all;
}

class ChartTest : public HttpTest {
 protected:
  std::string scene_ = "/v1/scenes/" + post_scene(small_scene().dump());

  json start(const json& body, const httplib::Headers& headers = {}) {
    const auto result = client_.Post(scene_ + "/charts", headers, body.dump(), kJson);
    EXPECT_EQ(result->status, 202) << result->body;
    const json job = json::parse(result->body);
    EXPECT_EQ(result->get_header_value("Location"), job_path(job));
    EXPECT_EQ(job.at("chart"), scene_ + "/charts/" + job.at("id").get<std::string>() + ".svg");
    return job;
  }
  // Waits for the chart and returns its path without extension.
  std::string made(const json& job) {
    const auto told = client_.Get(job.at("events").get<std::string>());
    EXPECT_NE(told->body.find("event: done"), std::string::npos) << told->body;
    return scene_ + "/charts/" + job.at("id").get<std::string>();
  }
};

TEST_F(ChartTest, ReturnsSvgCsvAndJson) {
  const json job = start(ends_on("whitted"));
  EXPECT_EQ(job.at("frames"), 2 + 2 * 8);  // raycast and whitted, both precisions, 1 and 4 samples
  const std::string path = made(job);
  const auto numbers = client_.Get(path + ".json"), drawing = client_.Get(path + ".svg"),
             table = client_.Get(path + ".csv");
  EXPECT_EQ(numbers->get_header_value("Content-Type"), kJson);
  EXPECT_EQ(drawing->get_header_value("Content-Type"), "image/svg+xml");
  EXPECT_EQ(table->get_header_value("Content-Type"), "text/csv; charset=utf-8");
  EXPECT_EQ(drawing->body.rfind("<svg ", 0), 0U);
  const json chart = json::parse(numbers->body);
  ASSERT_EQ(chart.at("points").size(), 8U);
  EXPECT_EQ(cells(table->body), cells(chart.at("points")));
  EXPECT_EQ(chart.at("image"), json({{"width", 16}, {"height", 12}}));
  EXPECT_EQ(chart.at("reference").at("samples"), 16);
  const auto rmse = [&](std::size_t i) { return chart.at("points").at(i).at("rmse").get<double>(); };
  EXPECT_LT(rmse(5), rmse(4));  // 4 samples and 1 sample, technique of the reference
  EXPECT_GT(rmse(1), rmse(5));
  EXPECT_GT(chart.at("points").at(5).at("ssim"), chart.at("points").at(1).at("ssim"));
  for (const json& point : chart.at("points")) EXPECT_GT(point.at("cpu_ms").get<double>(), 0);
  EXPECT_EQ(get_known(path + ".svg", drawing->get_header_value("ETag"))->status, 304);
  EXPECT_NE(drawing->get_header_value("ETag"), table->get_header_value("ETag"));
}

TEST_F(ChartTest, ReportsPlanImageIntervalAndCertificate) {
  const json job = start(ends_on("whitted"));
  const json chart = json::parse(client_.Get(made(job) + ".json")->body);
  EXPECT_EQ(chart.at("noise_floor"), chart.at("reference").at("rmse"));
  EXPECT_GE(chart.at("threads"), 1);
  double cost = 0;
  for (const std::size_t i : chart.at("front")) {
    const json& point = chart.at("points").at(i);
    EXPECT_TRUE(point.at("on_front"));
    EXPECT_GE(point.at("cpu_ms"), cost);
    cost = point.at("cpu_ms");
  }
  for (const json& point : chart.at("points")) {
    const json &interval = point.at("interval").at("rmse"), &full = point.at("full_size");
    EXPECT_LE(interval.at("low"), point.at("rmse").get<double>() + 1e-12);
    EXPECT_GE(interval.at("high"), point.at("rmse").get<double>() - 1e-12);
    EXPECT_LE(full.at("low"), full.at("seconds"));
    EXPECT_GE(full.at("high"), full.at("seconds"));
    EXPECT_NEAR(full.at("seconds").get<double>(),
                point.at("cpu_ms").get<double>() / 1000 / chart.at("threads").get<double>(), 1e-9);
    EXPECT_LE(point.at("ssim"), 1);
    // The images of the chart are 16 pixels wide, so both URLs return the same image.
    const auto picture = client_.Get(point.at("picture").get<std::string>());
    ASSERT_EQ(picture->status, 200) << picture->body;
    EXPECT_TRUE(client_.Get(scene_ + "/frame.png?" + point.at("plan").get<std::string>())->body ==
                picture->body);
    EXPECT_NE(picture->get_header_value("Cache-Control").find("immutable"), std::string::npos);
    EXPECT_EQ(point.at("certificate").at("space"), "linear");
    const std::string kind = point.at("certificate").at("total").at("kind");
    EXPECT_NE(picture->get_header_value("Orrery-Error-Bound").find("kind=" + kind), std::string::npos);
  }
  EXPECT_EQ(client_.Get(chart.at("reference").at("picture").get<std::string>())->status, 200);
  for (const json& told : chart.at("recommendations")) {
    const json& point = chart.at("points").at(told.at("point").get<std::size_t>());
    EXPECT_LT(point.at("interval").at("rmse").at("high"), told.at("error"));
    EXPECT_NE(told.at("flags").get<std::string>().find("--precision"), std::string::npos) << told;
  }
}

TEST_F(ChartTest, PredictsFullSizeFromSmallerImages) {
  json asked = ends_on("whitted");
  asked["image"] = {{"width", 1600}, {"height", 1200}};
  asked["chart"] = {{"samples", 1}, {"rounds", 1}, {"width", 16}};
  const json chart = json::parse(client_.Get(made(start(asked)) + ".json")->body);
  EXPECT_EQ(chart.at("image").at("width"), 1600);
  EXPECT_EQ(chart.at("measured"), json({{"width", 16}, {"height", 12}}));
  const json& point = chart.at("points").at(0);
  EXPECT_TRUE(point.at("interval").is_null());
  EXPECT_TRUE(point.at("full_size").at("low").is_null());
  EXPECT_NEAR(point.at("full_size").at("seconds").get<double>(),
              point.at("cpu_ms").get<double>() / 1000 * 1e4 / chart.at("threads").get<double>(), 1e-6);
  EXPECT_NE(point.at("plan").get<std::string>().find("width=1600"), std::string::npos);
  EXPECT_NE(point.at("picture").get<std::string>().find("width=320&height=240"), std::string::npos)
      << point.at("picture");
}

TEST_F(ChartTest, PrefixesLinksBehindProxy) {
  Daemon daemon({"--path-prefix", "/render"});
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), kJson);
  const std::string scene = posted->get_header_value("Location");
  const json job =
      json::parse(daemon.client().Post(scene + "/charts", ends_on("raycast").dump(), kJson)->body);
  daemon.client().Get(job.at("events").get<std::string>());
  const std::string drawing = job.at("chart");
  const auto told = daemon.client().Get(drawing.substr(0, drawing.size() - 3) + "json");
  const std::string picture = json::parse(told->body).at("points").at(0).at("picture");
  EXPECT_EQ(picture.rfind("/render/v1/scenes/", 0), 0U) << picture;
  EXPECT_EQ(daemon.client().Get(picture)->status, 200);
}

TEST_F(ChartTest, KeepsNoImages) {
  Daemon daemon({"--job-bytes", "1"});
  const auto posted = daemon.client().Post("/v1/scenes", small_scene().dump(), kJson);
  const std::string path = posted->get_header_value("Location") + "/charts";
  const json job = json::parse(daemon.client().Post(path, ends_on("whitted").dump(), kJson)->body);
  EXPECT_FALSE(job.contains("first_frame"));
  const auto told = daemon.client().Get(job.at("events").get<std::string>());
  EXPECT_NE(told->body.find("event: done"), std::string::npos) << told->body;
  EXPECT_EQ(told->body.find("href"), std::string::npos);
  expect_problem(daemon.client().Get(job_path(job) + "/frames/0.png"), 404);
}

TEST_F(ChartTest, ReturnsConflictUntilFinished) {
  const json job = start({{"image", {{"width", 1024}, {"height", 1024}}}, {"chart", {{"samples", 1024}}}});
  const std::string id = job.at("id");
  const json problem = expect_problem(client_.Get(scene_ + "/charts/" + id + ".svg"), 409);
  EXPECT_NE(problem.at("detail").get<std::string>().find("0 of "), std::string::npos);
  EXPECT_EQ(client_.Delete(job_path(job))->status, 204);
  expect_problem(client_.Get(scene_ + "/charts/" + id + ".svg"), 404);
}

TEST_F(ChartTest, IsFoundOnlyUnderItsScene) {
  const std::string path = made(start(ends_on("raycast")));
  const std::string id = path.substr(path.rfind('/') + 1);
  expect_problem(client_.Get("/v1/scenes/" + post_scene(moving_scene().dump()) + "/charts/" + id + ".svg"),
                 404);
  for (const char* wrong : {"", ".png", ".svg.csv", ".SVG"}) expect_problem(client_.Get(path + wrong), 404);
  expect_problem(client_.Get(scene_ + "/charts/.svg"), 404);
  const auto other = client_.Post("/v1/jobs", small_scene().dump(), kJson);
  expect_problem(
      client_.Get(scene_ + "/charts/" + json::parse(other->body).at("id").get<std::string>() + ".svg"), 404);
  expect_problem(client_.Post("/v1/scenes/nothing/charts", "{}", kJson), 404);
}

TEST_F(ChartTest, StartsOneJobPerIdempotencyKey) {
  const httplib::Headers key{{"Idempotency-Key", "chart-1"}};
  const json job = start(ends_on("whitted"), key);
  EXPECT_EQ(start(ends_on("whitted"), key).at("id"), job.at("id"));
  json same = ends_on("whitted");
  same["render"]["accelerator"] = "auto";
  EXPECT_EQ(start(same, key).at("id"), job.at("id"));
  json other = ends_on("whitted");
  other["render"]["accelerator"] = "list";
  expect_problem(client_.Post(scene_ + "/charts", key, other.dump(), kJson), 422);
}

TEST_F(ChartTest, ReportsPointersOfInvalidInput) {
  const auto pointer = [&](const json& body) {
    const json problem = expect_problem(client_.Post(scene_ + "/charts", body.dump(), kJson), 422);
    return problem.at("errors").at(0).at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer({{"chart", {{"samples", 0}}}}), "/chart/samples");
  EXPECT_EQ(pointer({{"chart", {{"samples", 1025}}}}), "/chart/samples");
  EXPECT_EQ(pointer({{"chart", {{"rounds", 17}}}}), "/chart/rounds");
  EXPECT_EQ(pointer({{"chart", {{"width", 0}}}}), "/chart/width");
  EXPECT_EQ(pointer({{"chart", {{"round", 1}}}}), "/chart");
  EXPECT_EQ(pointer({{"render", {{"samples", 4}}}}), "/render/samples");
  EXPECT_EQ(pointer({{"render", {{"precision", "float"}}}}), "/render/precision");
  EXPECT_EQ(pointer({{"image", {{"width", 1025}, {"height", 1024}}}}), "/image");
  EXPECT_EQ(pointer({{"scene", small_scene()}}), "/scene");
  EXPECT_EQ(pointer({{"scene_id", "x"}}), "/scene_id");
  expect_problem(client_.Post(scene_ + "/charts", "[", kJson), 400);
  EXPECT_EQ(client_.Post(scene_ + "/charts", "", kJson)->status, 202);
}

}  // namespace
}  // namespace orrery
