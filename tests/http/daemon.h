#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace orrery {

// Process of `orrery serve` on a free port.
class Daemon {
 public:
  // `log` receives the log of all requests. Without `log`, warnings and errors go to standard error.
  explicit Daemon(const std::vector<std::string>& arguments = {}, std::optional<int> log = {});
  ~Daemon();
  Daemon(const Daemon&) = delete;

  int port() const { return port_; }
  int health_port() const { return health_port_; }
  httplib::Client client() const;
  // Returns a client with the address 127.0.0.X.
  httplib::Client client_at(int last_byte) const;
  httplib::Client health_client() const;

  void signal(int number) const;
  // Waits for the process to end. Returns its exit status, or 128 + the signal that ended it.
  int wait();
  bool running() const;

  // Returns the value of a series without labels in /metrics, or -1.
  double metric(const std::string& series) const;
  // Returns the resident memory in bytes.
  double resident_bytes() const;
  std::size_t open_files() const;

  // Returns the used processor time in seconds.
  double cpu_seconds() const;
  // Waits until the process is busy or idle. Returns false after `limit_s` seconds.
  bool wait_until_working(double limit_s = 600) const;
  bool wait_until_idle(double limit_s = 600) const;

 private:
  pid_t pid_ = -1;
  int port_ = 0, health_port_ = 0;
  int output_ = -1;
};

// Adds an argument that disables the limit on estimated rays, so that images may take hours.
std::vector<std::string> without_ray_limit(std::vector<std::string> arguments = {});

// Returns the path of the program under test.
std::string program();

// Plain TCP connection to the daemon, for requests that HTTP libraries cannot send.
class RawClient {
 public:
  // `receive_buffer` is the size of the kernel's receive buffer in bytes, or 0 for its default. The client's
  // address is 127.0.0.`from`.
  explicit RawClient(int port, int receive_buffer = 0, std::uint8_t from = 1);
  ~RawClient();
  RawClient(const RawClient&) = delete;

  void send(const std::string& bytes) const;
  // Receives until the daemon closes the connection or sends nothing for 5 s.
  std::string receive_all() const;
  std::string receive_some() const;
  // Receives until the connection ends. Returns true if it was reset.
  bool is_reset() const;
  void shutdown_send() const;
  void close();

 private:
  int fd_ = -1;
};

// Fixture with one daemon for all tests of a suite.
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

  // Sends a GET with `known` as If-None-Match. Closes the connection afterwards, because httplib would wait
  // for a body of the 304.
  httplib::Result get_known(const std::string& path, const std::string& known) {
    return daemon_->client().Get(path, {{"If-None-Match", known}, {"Connection", "close"}});
  }

  // Posts the scene and returns its id.
  std::string post_scene(const std::string& scene);

 private:
  static Daemon* daemon_;
};

// Returns a scene of a ball on a mirror, which renders in milliseconds. `more` adds or replaces members.
nlohmann::json small_scene(const nlohmann::json& more = nlohmann::json::object());

// Returns the small scene with a ball that moves to the side from 0 to 2 s.
nlohmann::json moving_scene();

// Returns the path of the job that the response body describes.
std::string job_path(const nlohmann::json& job);

// Expects `status` and matching problem details, and returns the details.
nlohmann::json expect_problem(const httplib::Result& result, int status);

struct StreamedFrame {
  nlohmann::json header;
  std::string png;
};
// Parses a body of application/x-orrery-frames. Fails the test if the body is malformed.
std::vector<StreamedFrame> parse_frames(const std::string& body);

bool is_png(const std::string& bytes);

}  // namespace orrery
