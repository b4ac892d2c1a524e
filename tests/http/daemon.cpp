#include "tests/http/daemon.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>

namespace orrery {
namespace {

using Clock = std::chrono::steady_clock;

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Reads the next line of output and returns the port at its end, or 0 if the line does not start with
// `begin`.
int port_from(int output, const std::string& begin) {
  std::string line;
  for (char c; read(output, &c, 1) == 1 && c != '\n';) line += c;
  return line.rfind(begin, 0) == 0 ? std::stoi(line.substr(line.find_last_of(": ") + 1)) : 0;
}

// Appends the exchange as one line of JSON to the file that TEST_EXCHANGES names. openapi.test.mjs checks the
// file against the service's OpenAPI description.
void record(const httplib::Request& request, const httplib::Response& response) {
  static std::ofstream* const file = [] {
    const char* path = std::getenv("TEST_EXCHANGES");
    return path ? new std::ofstream(path) : nullptr;
  }();
  if (!file) return;
  static std::mutex mutex;
  const auto headers_of = [](const httplib::Headers& headers) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [name, value] : headers) json[name] = value;
    return json;
  };
  const bool text = response.get_header_value("Content-Type").find("json") != std::string::npos;
  const nlohmann::json exchange = {{"method", request.method},
                                   {"path", request.path},
                                   {"request", request.body.size() < 100'000 ? request.body : ""},
                                   {"status", response.status},
                                   {"headers", headers_of(response.headers)},
                                   {"body", text ? response.body : ""}};
  const std::lock_guard lock(mutex);
  *file << exchange.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) << std::endl;
}

httplib::Client client_of(int port) {
  httplib::Client client("127.0.0.1", port);
  client.set_logger(record);
  client.set_read_timeout(600, 0);
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  return client;
}

}  // namespace

std::vector<std::string> without_ray_limit(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--request-rays", "1000000000000"});
  return arguments;
}

std::string program() {
  const char* path = std::getenv("TEST_ORRERY");
  if (!path) throw std::runtime_error("TEST_ORRERY must be the path of the program");
  return path;
}

Daemon::Daemon(const std::vector<std::string>& arguments, std::optional<int> log) {
  std::vector<std::string> words{program(), "serve", "--port", "0", "--health-port", "0"};
  if (!log) words.push_back("--quiet");
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::signal(SIGPIPE, SIG_IGN);  // so that a broken connection fails only one test
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // if the test process ends
    ::signal(SIGPIPE, SIG_DFL);        // the default of a shell
    dup2(ends[1], STDOUT_FILENO);
    if (log) dup2(*log, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ::close(ends[1]);
  output_ = ends[0];
  port_ = port_from(output_, "orrery listens on http://");
  health_port_ = port_from(output_, "health and metrics on port ");
  if (port_ == 0 || health_port_ == 0) throw std::runtime_error("cannot start the daemon");
}

Daemon::~Daemon() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    wait();
  }
  ::close(output_);
}

httplib::Client Daemon::client() const { return client_of(port_); }
httplib::Client Daemon::client_at(int last_byte) const {
  httplib::Client client = client_of(port_);
  client.set_interface("127.0.0." + std::to_string(last_byte));
  return client;
}
httplib::Client Daemon::health_client() const { return client_of(health_port_); }

void Daemon::signal(int number) const { kill(pid_, number); }

int Daemon::wait() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool Daemon::running() const { return kill(pid_, 0) == 0; }

double Daemon::metric(const std::string& series) const {
  const auto result = health_client().Get("/metrics");
  std::istringstream lines(result ? result->body : "");
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(series + " ", 0) == 0) return std::stod(line.substr(series.size() + 1));
  return -1;
}

double Daemon::resident_bytes() const {
  std::ifstream statm("/proc/" + std::to_string(pid_) + "/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::size_t Daemon::open_files() const {
  const std::filesystem::directory_iterator files("/proc/" + std::to_string(pid_) + "/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

double Daemon::cpu_seconds() const {
  std::ifstream stat("/proc/" + std::to_string(pid_) + "/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

bool Daemon::wait_until_working(double limit_s) const {
  const auto start = Clock::now();
  const double before = cpu_seconds();
  while (seconds_since(start) < limit_s) {
    if (cpu_seconds() - before >= 0.1) return true;
    pause();
  }
  return false;
}

bool Daemon::wait_until_idle(double limit_s) const {
  const auto start = Clock::now();
  while (seconds_since(start) < limit_s) {
    const double before = cpu_seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (cpu_seconds() - before <= 0.021) return true;
  }
  return false;
}

RawClient::RawClient(int port, int receive_buffer, std::uint8_t from) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
  if (receive_buffer > 0) setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + from);
  if (bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("cannot bind the client address");
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("cannot connect to the daemon");
}

RawClient::~RawClient() { close(); }

bool RawClient::is_reset() const {
  std::array<char, 4096> bytes;
  ssize_t count;
  do count = recv(fd_, bytes.data(), bytes.size(), 0);
  while (count > 0);
  return count < 0 && errno == ECONNRESET;
}

void RawClient::shutdown_send() const { shutdown(fd_, SHUT_WR); }

void RawClient::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

void RawClient::send(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;  // the daemon has stopped reading, and its response states the reason
    sent += static_cast<std::size_t>(count);
  }
}

std::string RawClient::receive_some() const {
  pollfd ready{fd_, POLLIN, 0};
  if (poll(&ready, 1, 5000) <= 0) return {};
  std::string bytes(64 * 1024, '\0');
  const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

std::string RawClient::receive_all() const {
  std::string all;
  for (std::string part; !(part = receive_some()).empty();) all += part;
  return all;
}

Daemon* HttpTest::daemon_ = nullptr;

std::string HttpTest::post_scene(const std::string& scene) {
  const auto result = client_.Post("/v1/scenes", scene, "application/json");
  if (!result || (result->status != 200 && result->status != 201)) {
    ADD_FAILURE() << (result ? result->body : "no response");
    return {};
  }
  return nlohmann::json::parse(result->body).at("id");
}

nlohmann::json small_scene(const nlohmann::json& more) {
  nlohmann::json scene = {
      {"version", 1},
      {"camera", {{"type", "perspective"}, {"eye", {0, 1, 4}}, {"look_at", {0, 0, 0}}}},
      {"image", {{"width", 48}, {"height", 32}}},
      {"background", {0.2, 0.3, 0.4}},
      {"materials",
       {{"plum", {{"type", "rough"}, {"kd", {0.6, 0.1, 0.4}}, {"ks", 0.5}}},
        {"silver", {{"type", "reflective"}, {"n", {0.14, 0.16, 0.13}}, {"k", {4.1, 2.3, 3.1}}}}}},
      {"lights", {{{"type", "directional"}, {"direction_to_light", {1, 2, 1}}}}},
      {"objects",
       {{{"type", "sphere"}, {"center", {0.4, 0, 0}}, {"radius", 0.7}, {"material", "plum"}},
        {{"type", "plane"}, {"point", {0, -0.7, 0}}, {"normal", {0, 1, 0}}, {"material", "silver"}}}}};
  scene.update(more);
  return scene;
}

std::string job_path(const nlohmann::json& job) { return "/v1/jobs/" + job.at("id").get<std::string>(); }

nlohmann::json moving_scene() {
  const nlohmann::json ball = {
      {"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 0.4}, {"material", "plum"}};
  return small_scene(
      {{"models", {{"ball", {{"objects", {ball}}}}}},
       {"instances",
        {{{"model", "ball"}, {"motion", {{{"time", 0}}, {{"time", 2}, {"translate", {1, 0, 1}}}}}}}}});
}

nlohmann::json expect_problem(const httplib::Result& result, int status) {
  if (!result) {
    ADD_FAILURE() << "no response: " << httplib::to_string(result.error());
    return {};
  }
  EXPECT_EQ(result->status, status) << result->body;
  EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
  const auto problem = nlohmann::json::parse(result->body, nullptr, false);
  if (!problem.is_object()) {
    ADD_FAILURE() << result->body;
    return {};
  }
  EXPECT_EQ(problem.value("status", 0), status);
  EXPECT_EQ(problem.value("request_id", ""), result->get_header_value("X-Request-ID"));
  for (const char* member : {"type", "title", "detail"})
    EXPECT_FALSE(problem.value(member, "").empty()) << member;
  return problem;
}

std::vector<StreamedFrame> parse_frames(const std::string& body) {
  std::vector<StreamedFrame> frames;
  std::size_t at = 0;
  while (at < body.size()) {
    if (at + 4 > body.size()) return ADD_FAILURE() << "stream ends in a length", frames;
    std::size_t length = 0;
    for (int i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(body[at++]);
    if (at + length > body.size()) return ADD_FAILURE() << "stream ends in a header", frames;
    StreamedFrame frame{nlohmann::json::parse(body.substr(at, length)), {}};
    at += length;
    const std::size_t bytes = frame.header.at("bytes");
    if (at + bytes > body.size()) return ADD_FAILURE() << "stream ends in an image", frames;
    frame.png = body.substr(at, bytes);
    at += bytes;
    frames.push_back(std::move(frame));
  }
  return frames;
}

bool is_png(const std::string& bytes) { return bytes.rfind("\x89PNG\r\n\x1a\n", 0) == 0; }

}  // namespace orrery
