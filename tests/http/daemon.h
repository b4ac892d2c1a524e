#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace orrery {

// A running `orrery serve` on a free port.
class Daemon {
 public:
  // log: where it writes its log, of all requests; none: warnings and errors, on our standard error.
  explicit Daemon(const std::vector<std::string>& arguments = {}, std::optional<int> log = {});
  ~Daemon();
  Daemon(const Daemon&) = delete;

  int port() const { return port_; }
  int health_port() const { return health_port_; }
  httplib::Client client() const;
  // Of another client: at 127.0.0.X.
  httplib::Client client_at(int last_byte) const;
  httplib::Client health_client() const;

  void signal(int number) const;
  // Waits for the end and returns the exit status, or 128 + the signal that ended it.
  int wait();
  bool running() const;

  // The value of a series without labels in /metrics, or -1.
  double metric(const std::string& series) const;
  // Memory in use, bytes.
  double resident_bytes() const;
  std::size_t open_files() const;

  // Processor time used so far, seconds.
  double cpu_seconds() const;
  // Waits until it uses the processor, or until it no longer does. False after `limit_s`.
  bool wait_until_working(double limit_s = 600) const;
  bool wait_until_idle(double limit_s = 600) const;

 private:
  pid_t pid_ = -1;
  int port_ = 0, health_port_ = 0;
  int output_ = -1;
};

// These arguments of a daemon, and one more: pictures that take hours are not refused.
std::vector<std::string> with_endless_pictures(std::vector<std::string> arguments = {});

// The program under test.
std::string program();

// A plain TCP connection to the daemon, for requests that no HTTP library would send.
class RawClient {
 public:
  // receive_buffer: bytes that the kernel keeps for us, 0 for its own choice. from: the last byte of our
  // address, 127.0.0.X.
  explicit RawClient(int port, int receive_buffer = 0, std::uint8_t from = 1);
  ~RawClient();
  RawClient(const RawClient&) = delete;

  void send(const std::string& bytes) const;
  // All that comes until the daemon closes, or until nothing came for 5 s.
  std::string receive_all() const;
  std::string receive_some() const;
  // Receives to the end. Whether that was a reset.
  bool is_reset() const;
  void send_no_more() const;
  void close();

 private:
  int fd_ = -1;
};

// Tests of one suite share a daemon.
class HttpTest : public ::testing::Test {
 public:
  static void SetUpTestSuite() { daemon_ = new Daemon; }
  static void TearDownTestSuite() {
    delete daemon_;
    daemon_ = nullptr;
  }

 protected:
  static Daemon& daemon() { return *daemon_; }
  httplib::Client client_ = daemon_->client();

  // GET by a client that has what `known` stands for. The connection is closed afterwards: httplib would wait
  // for the body of a 304 that has none.
  httplib::Result get_known(const std::string& path, const std::string& known) {
    return daemon_->client().Get(path, {{"If-None-Match", known}, {"Connection", "close"}});
  }

  // Posts the scene and returns its id.
  std::string post_scene(const std::string& scene);

 private:
  static Daemon* daemon_;
};

// A ball on a mirror, small enough to render in no time. `more` replaces or adds members.
nlohmann::json small_scene(const nlohmann::json& more = nlohmann::json::object());

// The same with a ball that moves to the side from 0 to 2 s.
nlohmann::json moving_scene();

// Where the job that an answer tells of is to be asked for.
std::string job_path(const nlohmann::json& job);

// The body is problem details that agree with the status; returns it.
nlohmann::json expect_problem(const httplib::Result& result, int status);

struct StreamedFrame {
  nlohmann::json header;
  std::string png;
};
// Takes apart a body of application/x-orrery-frames; fails the test if it is not one.
std::vector<StreamedFrame> parse_frames(const std::string& body);

bool is_png(const std::string& bytes);

}  // namespace orrery
