#include <signal.h>

#include <thread>

#include "core/base/hash.h"
#include "tests/http/daemon.h"
#include "tests/support/eventually.h"

// Tests uncommon requirements of RFC 9110 and 9112.
namespace orrery {
namespace {

class Conformance : public HttpTest {
 protected:
  // Returns the response to `bytes`, which must close the connection.
  std::string answer_to(const std::string& bytes) {
    const RawClient raw(daemon().port());
    raw.send(bytes);
    return raw.receive_all();
  }
};

constexpr const char* kLast = " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";

TEST_F(Conformance, ServesAbsoluteTargets) {  // RFC 9112, 3.2.2
  for (const char* target : {"http://somewhere/healthz", "HTTP://x:8080/healthz", "https://[::1]/healthz?"})
    EXPECT_EQ(answer_to(std::string("GET ") + target + kLast).substr(9, 3), "200") << target;
  EXPECT_EQ(answer_to("GET http://x/nosuch" + std::string(kLast)).substr(9, 3), "404");
  EXPECT_EQ(answer_to("GET http://x" + std::string(kLast)).substr(9, 3), "200");
}

TEST_F(Conformance, AnswersServerOptionsWithoutBody) {  // RFC 9110, 9.3.7
  const std::string answer = answer_to("OPTIONS *" + std::string(kLast));
  EXPECT_EQ(answer.substr(0, 25), "HTTP/1.1 204 No Content\r\n");
  EXPECT_NE(answer.find("\r\nAllow: DELETE, GET, HEAD, OPTIONS, POST, PUT\r\n"), std::string::npos) << answer;
  EXPECT_EQ(answer.find("Content-Length"), std::string::npos);
  EXPECT_TRUE(answer.ends_with("\r\n\r\n"));
}

TEST_F(Conformance, ListsMethodsOfPathInOptions) {
  const std::string answer = answer_to("OPTIONS /v1/render" + std::string(kLast));
  EXPECT_EQ(answer.substr(9, 3), "204");
  EXPECT_NE(answer.find("\r\nAllow: OPTIONS, POST\r\n"), std::string::npos) << answer;
  EXPECT_EQ(answer_to("OPTIONS /nosuch" + std::string(kLast)).substr(9, 3), "404");
}

TEST_F(Conformance, SkipsEmptyLinesBeforeRequest) {  // RFC 9112, 2.2
  const std::string request = std::string("GET /healthz") + kLast;
  EXPECT_EQ(answer_to("\r\n" + request).substr(9, 3), "200");
  EXPECT_EQ(answer_to("\r\n\r\n\r\n" + request).substr(9, 3), "200");
  EXPECT_EQ(answer_to("\n" + request).substr(9, 3), "400");
  std::string many;
  for (int i = 0; i < 9; ++i) many += "\r\n";
  EXPECT_EQ(answer_to(many + request).substr(9, 3), "400");
}

TEST_F(Conformance, SkipsEmptyLinesBetweenRequests) {
  const RawClient raw(daemon().port());
  raw.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n\r\n");
  EXPECT_EQ(raw.receive_some().substr(9, 3), "200");
  for (const char* piece : {"\r", "\nGET /nosuch", kLast}) raw.send(piece);
  EXPECT_NE(raw.receive_all().find("HTTP/1.1 404"), std::string::npos);
}

TEST_F(Conformance, SendsNoContinueToHttp10Clients) {  // RFC 9110, 10.1.1
  const RawClient raw(daemon().port());
  const std::string scene = small_scene().dump();
  raw.send("POST /v1/render HTTP/1.0\r\nExpect: 100-continue\r\nContent-Length: " +
           std::to_string(scene.size()) + "\r\n\r\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  raw.send(scene);
  EXPECT_EQ(raw.receive_all().substr(0, 12), "HTTP/1.1 200");
}

TEST(Shutdown, GivesPartialRequestsGracePeriod) {
  Daemon daemon;
  const std::string post = "POST /v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n{";
  const RawClient head(daemon.port()), body(daemon.port()), ends(daemon.port());
  head.send("GET /healthz HTTP/1.1\r\nHo");
  ends.send("GET /healthz HTTP/1.1\r\nHo");
  body.send(post);
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_connections") >= 3; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  daemon.signal(SIGTERM);
  ends.send("st: x\r\n\r\n");
  EXPECT_EQ(ends.receive_all().substr(9, 3), "200");
  for (const RawClient* raw : {&head, &body}) {
    const std::string answer = raw->receive_all();
    EXPECT_EQ(answer.substr(9, 3), "503");  // 408 would be the usual timeout
    EXPECT_NE(answer.find("before the service shut down"), std::string::npos) << answer;
  }
  EXPECT_EQ(daemon.wait(), 0);
}

// Includes a client that shuts down its sending side long before it reads the response, which is larger than
// all buffers.
TEST(Disconnect, IsNotCountedAfterCompleteResponse) {
  Daemon daemon;
  for (int i = 0; i < 200; ++i) {
    const RawClient raw(daemon.port());
    raw.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_NE(raw.receive_some().find("200"), std::string::npos);
  }
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n#" + std::string(20'000'000, ' ') + "\n";
  const std::string path = "/v1/assets/" + sha256_hex(mesh);
  ASSERT_EQ(daemon.client().Put(path, mesh, "application/octet-stream")->status, 201);
  {
    const RawClient raw(daemon.port(), 4096);
    raw.send("GET " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    std::string answer = raw.receive_some();
    raw.shutdown_send();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    answer += raw.receive_all();
    EXPECT_TRUE(answer.ends_with(mesh));
  }
  ASSERT_TRUE(test::eventually([&] { return daemon.metric("orrery_connections") == 0; }));
  EXPECT_EQ(daemon.metric("orrery_clients_left_total"), 0);
}

}  // namespace
}  // namespace orrery
