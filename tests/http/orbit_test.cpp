#include <future>

#include "core/base/number.h"
#include "server/http/server.h"
#include "tests/http/daemon.h"
#include "tests/support/sanitized.h"

namespace orrery {
namespace {

const httplib::Headers kFrames{{"Accept", "application/x-orrery-frames"}};

class OrbitStream : public HttpTest {
 protected:
  std::string path(const std::string& query) {
    return "/v1/scenes/" + post_scene(small_scene().dump()) + "/orbit?" + query;
  }
};

TEST_F(OrbitStream, SendsFramesInOrderWithHeaders) {
  const auto result = client_.Get(path("frames=6&step=30&azimuth=10&elevation=5&fps=0"), kFrames);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->get_header_value("Content-Type"), "application/x-orrery-frames");
  const auto frames = parse_frames(result->body);
  ASSERT_EQ(frames.size(), 6u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& header = frames[i].header;
    EXPECT_EQ(header.at("frame"), i);
    EXPECT_EQ(header.at("azimuth_degrees"), 10 + 30.0 * static_cast<double>(i));
    EXPECT_EQ(header.at("elevation_degrees"), 5);
    EXPECT_EQ(header.at("distance"), 1);
    EXPECT_EQ(header.at("width"), 48);
    EXPECT_EQ(header.at("height"), 32);
    EXPECT_EQ(header.at("skipped"), 0);
    EXPECT_GE(header.at("rays"), 48 * 32);
    EXPECT_GE(header.at("render_ms"), 0);
    EXPECT_GE(header.at("encode_ms"), 0);
    EXPECT_TRUE(is_png(frames[i].png));
  }
}

TEST_F(OrbitStream, MakesFullTurnByDefault) {
  const auto frames = parse_frames(client_.Get(path("frames=8&fps=0"), kFrames)->body);
  ASSERT_EQ(frames.size(), 8u);
  EXPECT_EQ(frames[7].header.at("azimuth_degrees"), 315);
}

TEST_F(OrbitStream, PlaysMotion) {
  const std::string scene = "/v1/scenes/" + post_scene(moving_scene().dump());
  const auto times = [&](const std::string& query) {
    std::vector<double> all;
    for (const auto& frame : parse_frames(client_.Get(scene + "/orbit?fps=0&step=0&" + query, kFrames)->body))
      all.push_back(frame.header.at("time"));
    return all;
  };
  EXPECT_EQ(times("frames=4"), (std::vector<double>{0, 0.5, 1, 1.5}));
  EXPECT_EQ(times("frames=4&time=1"), (std::vector<double>{1, 1.25, 1.5, 1.75}));
  EXPECT_EQ(times("frames=4&time_step=0.75"), (std::vector<double>{0, 0.75, 1.5, 0.25}));
  const auto frames = parse_frames(client_.Get(scene + "/orbit?fps=0&step=0&frames=4", kFrames)->body);
  EXPECT_NE(frames[0].png, frames[1].png);
  const auto still = parse_frames(client_.Get(scene + "/orbit?fps=0&frames=1&time=0.5", kFrames)->body);
  EXPECT_EQ(still[0].png, frames[1].png);
  expect_problem(client_.Get(scene + "/orbit?time=abc", kFrames), 422);
  expect_problem(client_.Get(scene + "/orbit?time=2e6", kFrames), 422);
  expect_problem(client_.Get(scene + "/orbit?time_step=3601", kFrames), 422);
}

TEST_F(OrbitStream, SendsMultipartToBrowsers) {
  const auto result = client_.Get(path("frames=3&fps=0"), {{"Accept", "image/avif,image/*,*/*;q=0.8"}});
  ASSERT_TRUE(result);
  const std::string type = result->get_header_value("Content-Type");
  const std::string prefix = "multipart/x-mixed-replace; boundary=";
  ASSERT_EQ(type.substr(0, prefix.size()), prefix);
  const std::string boundary = "--" + type.substr(prefix.size());
  std::string rest = result->body;
  ASSERT_EQ(rest.rfind(boundary + "\r\n", 0), 0u);
  rest.erase(0, boundary.size() + 2);
  for (int i = 0; i < 3; ++i) {
    const std::size_t blank = rest.find("\r\n\r\n");
    ASSERT_NE(blank, std::string::npos);
    const std::string head = rest.substr(0, blank);
    EXPECT_NE(head.find("Content-Type: image/png"), std::string::npos);
    const std::size_t length = std::stoul(head.substr(head.find("Content-Length: ") + 16));
    EXPECT_TRUE(is_png(rest.substr(blank + 4)));
    rest.erase(0, blank + 4 + length);
    const std::string end = "\r\n" + boundary + (i == 2 ? "--\r\n" : "\r\n");
    ASSERT_EQ(rest.substr(0, end.size()), end);
    rest.erase(0, end.size());
  }
  EXPECT_TRUE(rest.empty());
}

TEST_F(OrbitStream, MatchesImagesOfSameAngle) {
  const auto scene = small_scene();
  const auto frames = parse_frames(client_.Get(path("frames=4&fps=0"), kFrames)->body);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_NE(frames[0].png, frames[1].png);
  const auto again = parse_frames(client_.Get(path("frames=2&fps=0&azimuth=90"), kFrames)->body);
  ASSERT_EQ(again.size(), 2u);
  EXPECT_EQ(again[0].png, frames[1].png);
}

TEST_F(OrbitStream, ReportsErrorBoundOfFrames) {
  const std::string scene = "/v1/scenes/" + post_scene(small_scene().dump());
  const std::string turned = "azimuth=90&samples=2&precision=double";
  const std::string bound =
      client_.Get(scene + "/frame.png?" + turned)->get_header_value("Orrery-Error-Bound");
  EXPECT_EQ(bound.rfind("rms=0.", 0), 0u) << bound;
  const std::string orbit = scene + "/orbit?frames=1&" + turned;
  const auto parts = client_.Get(orbit);
  EXPECT_NE(parts->body.find("Orrery-Error-Bound: " + bound + "\r\n"), std::string::npos) << bound;
  const auto told = parse_frames(client_.Get(orbit, kFrames)->body).at(0).header.at("bound");
  EXPECT_EQ(told.at("total").at("kind"), "estimated");
  EXPECT_EQ(bound.rfind("rms=" + rounded(told.at("total").at("rms")) + ";kind=estimated", 0), 0u) << bound;
}

TEST_F(OrbitStream, WarnsAboutUselessImages) {
  EXPECT_FALSE(client_.Get(path("frames=1"), kFrames)->has_header("Orrery-Warning"));
  const std::string inside =
      client_.Get(path("frames=1&distance=0.05"), kFrames)->get_header_value("Orrery-Warning");
  EXPECT_EQ(inside.rfind("/camera/eye: camera is inside", 0), 0u) << inside;
}

TEST_F(OrbitStream, RejectsInvalidParametersBeforeStreaming) {
  for (const char* query :
       {"frames=0", "frames=3601", "frames=1.5", "frames=abc", "fps=-1", "fps=241", "step=361", "step=nan",
        "width=0", "samples=1e9", "speed=3", "azimuth=1e9&step=1"})
    expect_problem(client_.Get(path(query), kFrames), 422);
}

TEST_F(OrbitStream, SelectsFormatByAccept) {
  const std::string url = path("frames=1");
  const auto type_for = [&](const char* accept) {
    return client_.Get(url, {{"Accept", accept}})->get_header_value("Content-Type").substr(0, 27);
  };
  EXPECT_EQ(type_for("APPLICATION/X-ORRERY-FRAMES"), "application/x-orrery-frames");
  EXPECT_EQ(type_for("application/x-orrery-frames;q=0, */*"), "multipart/x-mixed-replace; ");
  expect_problem(client_.Get(url, {{"Accept", "text/html"}}), 406);
}

TEST_F(OrbitStream, PacesFramesAtTinyRate) {
  httplib::Client client = daemon().client();
  client.set_read_timeout(std::chrono::seconds(3));
  std::string body;
  const auto take = [&](const char* bytes, std::size_t size) {
    body.append(bytes, size);
    return true;
  };
  EXPECT_FALSE(client.Get(path("frames=40&fps=1e-300"), kFrames, take));  // the second frame is never due
  EXPECT_EQ(parse_frames(body).size(), 1u);
}

TEST_F(OrbitStream, SendsCurrentFrameToLateViewerAtOnce) {
  const std::string url = path("frames=40&fps=1e-6");
  const auto first_frame = [&] {
    std::string body;
    httplib::Client client = daemon().client();
    client.Get(url, kFrames, [&](const char* bytes, std::size_t size) {
      body.append(bytes, size);
      return false;
    });
    return body;
  };
  auto other = daemon().client();
  std::promise<void> seen;
  auto early = std::async(std::launch::async, [&] {
    other.set_read_timeout(std::chrono::milliseconds(2000));
    bool once = false;
    other.Get(url, kFrames, [&](const char*, std::size_t) {
      if (!std::exchange(once, true)) seen.set_value();
      return true;
    });
  });
  seen.get_future().wait();
  const auto late = parse_frames(first_frame());
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].header.at("frame"), 0);
}

TEST(OrbitFailure, ReportsTimeoutOfFirstFrame) {
  Daemon daemon(without_ray_limit({"--request-seconds", "1"}));
  httplib::Client client = daemon.client();
  const auto posted = client.Post("/v1/scenes", small_scene().dump(), "application/json");
  const std::string id = nlohmann::json::parse(posted->body).at("id");
  const std::string heavy = "/v1/scenes/" + id + "/orbit?frames=3&width=4096&height=4096&samples=1024";
  expect_problem(client.Get(heavy, kFrames), 504);
}

TEST(OrbitFailure, AbortsFailedStream) {
  const auto answer = [](Request&) {
    Response response;
    response.set("Content-Type", "text/plain");
    response.stream = [](Sink& sink) {
      sink.write("begun");
      throw Error("no more");
    };
    return response;
  };
  // Note of the response, and true if the client disconnected.
  std::promise<std::pair<std::string, bool>> served;
  HttpServer server({.host = "127.0.0.1", .port = 0},
                    {.admit = [&](Request&) -> HttpServer::Admitted {
                       return {{}, answer};
                     },
                     .refuse = [](const Request&, std::exception_ptr) { return Response{}; },
                     .served =
                         [&](const Request&, const Response& response, std::uint64_t, bool gone) {
                           served.set_value({response.note, gone});
                         },
                     .grace_over = [] {}});
  std::thread thread([&] { server.run(); });
  EXPECT_FALSE(httplib::Client("127.0.0.1", server.port()).Get("/"));  // the last chunk is missing
  EXPECT_EQ(served.get_future().get(), std::pair(std::string("no more"), false));
  served = {};
  const RawClient old(server.port());
  old.send("GET / HTTP/1.0\r\n\r\n");
  EXPECT_TRUE(old.is_reset());  // an orderly close would look like the end of the body
  server.drain();
  thread.join();
}

TEST_F(OrbitStream, DoesNotRenderForHead) {
  const auto head = client_.Head(path("frames=3600&width=4096&height=4096&samples=4096"));
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_TRUE(daemon().wait_until_idle());
}

TEST_F(OrbitStream, RendersEqualOrbitsOnce) {
  const std::string url = path("frames=30&fps=20&distance=1.25");
  const auto watch = [&] {
    httplib::Client client = daemon().client();
    return client.Get(url, kFrames)->body;
  };
  auto other = std::async(std::launch::async, watch);
  const auto mine = parse_frames(watch()), others = parse_frames(other.get());
  std::map<int, nlohmann::json> by_number;
  for (const auto& frame : mine) by_number[frame.header.at("frame")] = frame.header;
  int common = 0, shared = 0;
  for (const auto& frame : others) {
    const auto& twin = by_number[frame.header.at("frame")];
    common += !twin.is_null();
    // Separate renders of a frame never have exactly equal times.
    if (!twin.is_null() && twin.at("render_ms") == frame.header.at("render_ms") &&
        twin.at("encode_ms") == frame.header.at("encode_ms"))
      ++shared;
  }
  EXPECT_GT(shared, common / 2);  // a busy machine skips frames
}

TEST_F(OrbitStream, SendsWholeOrbitToLateViewer) {
  const std::string url = path("frames=20&fps=20&distance=1.5");
  auto first = std::async(std::launch::async, [&] { return daemon().client().Get(url, kFrames)->body; });
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  const auto late = parse_frames(client_.Get(url, kFrames)->body), early = parse_frames(first.get());
  for (const auto& frames : {early, late}) {
    ASSERT_FALSE(frames.empty());
    EXPECT_EQ(frames.size() + frames.back().header.at("skipped").get<std::size_t>(), 20u);
  }
}

// Client that requests more frames than the kernel buffers can store, and reads none before receive().
class SlowViewer {
 public:
  SlowViewer(int port, const std::string& url) : raw_(port, 8 * 1024) {
    raw_.send("GET " + url +
              " HTTP/1.1\r\nHost: x\r\nAccept: application/x-orrery-frames\r\nConnection: close\r\n\r\n");
  }

  std::vector<StreamedFrame> receive() const {
    const std::string answer = raw_.receive_all();
    std::string body;  // without the framing of chunks
    for (std::size_t at = answer.find("\r\n\r\n") + 4; at < answer.size();) {
      const std::size_t length = std::stoul(answer.substr(at), nullptr, 16);
      at = answer.find("\r\n", at) + 2;
      body += answer.substr(at, length);
      at += length + 2;
    }
    return parse_frames(body);
  }

 private:
  RawClient raw_;
};

TEST_F(OrbitStream, DoesNotDelayOthersAtSlowRate) {
  const std::string orbit = path("frames=4&fps=");
  const SlowViewer slow(daemon().port(), orbit + "1e-7");
  EXPECT_EQ(parse_frames(client_.Get(orbit + "0", kFrames)->body).size(), 4u);
}

const std::string kLargeFrames = "frames=24&width=640&height=480&distance=1.1";

void expect_some_skipped(const std::vector<StreamedFrame>& seen) {
  ASSERT_FALSE(seen.empty());
  const int skipped = seen.back().header.at("skipped");
  EXPECT_GT(skipped, 0);
  EXPECT_EQ(seen.size() + static_cast<std::size_t>(skipped), 24u);
}

TEST_F(OrbitStream, SkipsFramesOnlyForSlowViewer) {
  const std::string url =
      // The stream ends within the write timeout.
      path(kLargeFrames + (test::kSanitized ? "&fps=3" : "&fps=4"));
  const SlowViewer slow(daemon().port(), url);
  const auto fast = parse_frames(client_.Get(url, kFrames)->body);
  expect_some_skipped(slow.receive());  // starts to read
  ASSERT_FALSE(fast.empty());
  EXPECT_EQ(fast.back().header.at("skipped"), 0);
}

TEST_F(OrbitStream, SkipsOverdueFramesForSingleSlowViewer) {
  const SlowViewer slow(daemon().port(), path(kLargeFrames + "&fps=10"));
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));  // longer than the orbit's duration
  ASSERT_TRUE(daemon().wait_until_idle());  // waits until no more frames are sent, even if rendering is slow
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));  // 10 frames are due in this time
  expect_some_skipped(slow.receive());
}

}  // namespace
}  // namespace orrery
