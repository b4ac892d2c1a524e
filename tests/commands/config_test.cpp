#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

// Tests the sources of the service's settings and the errors for invalid settings.
namespace orrery {
namespace {

namespace fs = std::filesystem;

class Config : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("orrery-config-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  struct Outcome {
    int status;
    std::string out, err;
  };
  // `environment`: "NAME=VALUE ..."
  Outcome serve(const std::string& arguments, const std::string& environment = "") const {
    const char* program = std::getenv("TEST_ORRERY");
    const std::string command = environment + " " + (program ? program : "orrery") + " serve " + arguments +
                                " >" + (folder_ / "out").string() + " 2>" + (folder_ / "err").string();
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), read("out"), read("err")};
  }
  nlohmann::json settings(const std::string& arguments, const std::string& environment = "") const {
    const Outcome outcome = serve("--print-config " + arguments, environment);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

 private:
  fs::path folder_;
};

TEST_F(Config, ReportsAllErrorsAtOnce) {
  const std::string file =
      write("config.json",
            R"({"port": 99999, "imagecachebytes": 1, "threads": "many", "insecure": 3, "jobs": [1]})");
  const std::string tokens = write("tokens", "alice read\nbob paint " + std::string(64, 'a') + "\n");
  const std::string key = write("key", "short");
  const Outcome outcome =
      serve("--check-config --config " + file + " --connections 0 --image-cache-bites 5 --tokens-file " +
                tokens + " --link-signing-key-file " + key +
                " --log loud --cors-origins '*,https://a.example:8443,HTTP://b,c,http://d/'",
            "ORRERY_PORTT=1 ORRERY_MAX_ORBIT_STREAMS=x ORRERY_COLOUR=red");
  EXPECT_EQ(outcome.status, 2);
  for (const std::string& line : {
           file + ": /port: must be an integer from 0 to 65535 (got 99999)",
           file + ": unknown setting imagecachebytes (did you mean image_cache_bytes?)",
           file + ": /threads: must be an integer from 0 to 1024 (got many)",
           file + ": /insecure: must be true or false (got 3)",
           file + ": /jobs: must be a number, a string, true or false (got [1])",
           std::string("--connections: must be an integer from 1 to 10000 (got 0)"),
           std::string("ORRERY_MAX_ORBIT_STREAMS: must be an integer from 1 to 10000 (got x)"),
           std::string("unknown setting ORRERY_PORTT (did you mean ORRERY_PORT?)"),
           std::string("unknown setting ORRERY_COLOUR"),
           std::string("unknown option --image-cache-bites (did you mean --image-cache-bytes?)"),
           tokens + ":1: must be a name, scopes and the SHA-256 of a token, separated by blanks",
           tokens + ":2: must be one of \"read\", \"render\", \"write\" or \"admin\" (got \"paint\")",
           key + ": key must have at least 32 bytes (got 5)",
           std::string("--log: must be text or json (got loud)"),
           std::string(
               "--cors-origins: must be *, null or origins such as https://app.example:8443 (got HTTP://b)"),
           std::string("--cors-origins: must be *, null or origins such as https://app.example:8443 (got c)"),
           std::string(
               "--cors-origins: must be *, null or origins such as https://app.example:8443 (got http://d/)"),
       })
    EXPECT_NE(("\n" + outcome.err).find("\norrery: " + line + "\n"), std::string::npos) << line << "\n"
                                                                                        << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 17) << outcome.err;
}

TEST_F(Config, RefusesToStartWithInvalidSettings) {
  for (const char* wrong : {"ORRERY_PORTT=1", "ORRERY_PORT=http", "ORRERY_CORS_ORIGIN=*"})
    EXPECT_EQ(serve("--port 0 --health-port 0", wrong).status, 2) << wrong;
  for (const char* wrong : {"--portt 0", "--port", "somewhere", "-x", "--port 8081",
                            "--host no.such.host.invalid", "--config /nonexistent", "--insecure=maybe"})
    EXPECT_EQ(serve(std::string("--health-port 8081 ") + wrong).status, 2) << wrong;
  EXPECT_NE(serve("serve --check-config").err.find("orrery: unknown argument serve\n"), std::string::npos);
}

TEST_F(Config, PrefersFlagsThenEnvironmentThenFile) {
  const std::string file =
      write("config.json", R"({"jobs": 3, "max_orbit_streams": 3, "threads": 3, "max_queued_rays": 1e6})");
  const auto all = settings("--config " + file + " --jobs 5", "ORRERY_JOBS=4 ORRERY_MAX_ORBIT_STREAMS=4");
  EXPECT_EQ(all.at("jobs"), 5);
  EXPECT_EQ(all.at("max_orbit_streams"), 4);
  EXPECT_EQ(all.at("threads"), 3);
  EXPECT_EQ(all.at("max_queued_rays"), 1'000'000);
  EXPECT_EQ(all.at("max_finished_jobs"), 1000);
}

TEST_F(Config, ReadsFormerNamesFromEverySource) {
  const std::string file = write("config.json", R"({"jobs_kept": 3, "queue_rays": 1e6})");
  const auto all = settings("--config " + file + " --orbits 5 --max-finished-jobs 6",
                            "ORRERY_RENDERS=4 ORRERY_ORBITS=7 ORRERY_STORE_BYTES=8000");
  EXPECT_EQ(all.at("max_queued_rays"), 1'000'000) << "file";
  EXPECT_EQ(all.at("max_finished_jobs"), 6) << "a flag overrides the file";
  EXPECT_EQ(all.at("max_orbit_streams"), 5) << "a flag overrides the environment";
  EXPECT_EQ(all.at("max_concurrent_renders"), 4) << "variable";
  EXPECT_EQ(all.at("scene_cache_bytes"), 8000) << "variable";
  EXPECT_FALSE(all.contains("jobs_kept"));
  EXPECT_EQ(settings("--orbits 5", "ORRERY_MAX_ORBIT_STREAMS=7").at("max_orbit_streams"), 5);
}

TEST_F(Config, RejectsFormerAndCurrentNameTogether) {
  const std::string file = write("config.json", R"({"jobs_kept": 3, "max_finished_jobs": 3})");
  const Outcome outcome = serve("--check-config --config " + file + " --orbits 5 --max-orbit-streams 5",
                                "ORRERY_RENDERS=4 ORRERY_MAX_CONCURRENT_RENDERS=4");
  EXPECT_EQ(outcome.status, 2);
  for (const std::string& line : {
           file + ": /jobs_kept is the former name of /max_finished_jobs; give only /max_finished_jobs",
           std::string("--orbits is the former name of --max-orbit-streams; give only --max-orbit-streams"),
           std::string("ORRERY_RENDERS is the former name of ORRERY_MAX_CONCURRENT_RENDERS; give only "
                       "ORRERY_MAX_CONCURRENT_RENDERS"),
       })
    EXPECT_NE(outcome.err.find(line), std::string::npos) << line << "\n" << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
}

TEST_F(Config, ScalesBudgetsWithMemory) {
  const auto usual = settings(""), half = settings("--memory-bytes 1610612736 --film-cache-bytes 1000");
  for (const char* budget : {"request_buffer_bytes", "response_buffer_bytes", "scene_cache_bytes",
                             "asset_store_bytes", "job_bytes"})
    EXPECT_EQ(half.at(budget), usual.at(budget).get<std::size_t>() / 2) << budget;
  EXPECT_EQ(half.at("film_cache_bytes"), 1000) << "explicit settings are not scaled";
  const auto small = settings("--memory-bytes 160000000");
  EXPECT_EQ(small.at("asset_bytes"), small.at("asset_store_bytes")) << "an asset must fit in the store";
  const Outcome refused = serve("--check-config --job-bytes 3000000000");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("orrery: --memory-bytes: memory_bytes must be at least "), std::string::npos)
      << refused.err;
}

TEST_F(Config, ReadsEveryKindOfValueFromEverySource) {
  const std::string file = write(
      "config.json", R"({"host": "localhost", "insecure": true, "cors_origins": ["http://a", "http://b"]})");
  const auto from_file = settings("--config " + file);
  EXPECT_EQ(from_file.at("host"), "localhost");
  EXPECT_EQ(from_file.at("insecure"), true);
  EXPECT_EQ(from_file.at("cors_origins"), nlohmann::json({"http://a", "http://b"}));
  const auto from_environment =
      settings("", "ORRERY_INSECURE=yes ORRERY_CORS_ORIGINS=http://a,http://b ORRERY_HOST=::1");
  EXPECT_EQ(from_environment.at("insecure"), true);
  EXPECT_EQ(from_environment.at("cors_origins"), nlohmann::json({"http://a", "http://b"}));
  EXPECT_EQ(from_environment.at("host"), "::1");
  const auto from_flags = settings("--insecure --cors-origins http://a --cors-origins http://b,http://c");
  EXPECT_EQ(from_flags.at("insecure"), true);
  EXPECT_EQ(from_flags.at("cors_origins"), nlohmann::json({"http://a", "http://b", "http://c"}));
  EXPECT_EQ(settings("--config " + file + " --insecure=false --host 127.0.0.1").at("insecure"), false);
}

TEST_F(Config, RoundTripsPrintedSettings) {
  const std::string arguments = "--jobs 7 --cors-origins http://a,http://b --grace-seconds 9 --insecure";
  const Outcome printed = serve("--print-config " + arguments);
  EXPECT_EQ(serve("--print-config --config " + write("config.json", printed.out)).out, printed.out);
  EXPECT_EQ(nlohmann::json::parse(printed.out).at("grace_seconds"), 9);
}

TEST_F(Config, IgnoresClientTokenVariable) {
  EXPECT_EQ(serve("--check-config", "ORRERY_TOKEN=abc").status, 0);
}

}  // namespace
}  // namespace orrery
