#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <mutex>

#include "core/base/version.h"
#include "core/math/instruction_level.h"
#include "server/commands/commands.h"
#include "server/commands/signals.h"
#include "server/http/listener.h"
#include "server/service.h"

namespace orrery {
namespace {

constexpr const char* kExamples = R"(
Examples:
  orrery serve                                     then open http://127.0.0.1:8080
  orrery serve --port 0                            any free port; the first line printed says which
  curl --data-binary @scenes/paper.json http://127.0.0.1:8080/v1/render -o paper.png

SIGTERM or Ctrl-C ends it: running requests are answered, streams stop after a frame. A second one ends it at once.
)";

struct Options {
  Settings settings;
  int request_seconds = 60, grace_seconds = 30;
  bool insecure = false, quiet = false;
  std::string log = isatty(STDERR_FILENO) ? "text" : "json";
};

int serve(const Options& options) {
  Settings settings = options.settings;
  settings.request_time = std::chrono::seconds(options.request_seconds);
  settings.grace = std::chrono::seconds(options.grace_seconds);
  if (!options.insecure && !is_loopback(settings.host))
    throw InputError("--host", settings.host +
                                   " can be reached from other machines, and everyone who reaches it may "
                                   "render; give --insecure if that is meant");
  // The signals are taken before the service starts threads; it learns of them once it is there.
  std::mutex mutex;
  Service* running = nullptr;  // guarded by mutex
  const SignalWatch signals([&] {
    const std::lock_guard lock(mutex);
    if (running) running->stop();
  });
  const Log log(options.log == "json" ? LogForm::json : LogForm::text,
                options.quiet ? LogLevel::warning : LogLevel::info);
  Service service(settings, log);
  {
    const std::lock_guard lock(mutex);
    running = &service;
    if (signals.interrupted()) service.stop();
  }
  const bool v6 = settings.host.find(':') != std::string::npos;
  std::cout << "orrery listens on http://" << (v6 ? "[" + settings.host + "]" : settings.host) << ":"
            << service.port() << "\nhealth and metrics on port " << service.health_port() << std::endl;
  log.write(LogLevel::info, "start",
            {{"version", kVersion}, {"instructions", instruction_level()}, {"port", service.port()}});
  service.run();
  {
    const std::lock_guard lock(mutex);
    running = nullptr;
  }
  log.write(LogLevel::info, "end", nlohmann::ordered_json::object());
  return kDone;
}

void add_limit_options(CLI::App& app, Options& options) {
  Settings& settings = options.settings;
  const auto add = [&](const char* name, auto& value, std::int64_t most, const char* help) {
    app.add_option(name, value, help)
        ->check(CLI::Range(std::int64_t{1}, most).description(""))
        ->type_name("N")
        ->capture_default_str()
        ->group("Limits");
  };
  add("--max-body", settings.body_bytes, 1'000'000'000, "Bytes of a request's body");
  add("--max-bodies", settings.bodies_bytes, 1'000'000'000'000,
      "Bytes of the bodies of all requests at one time");
  add("--max-store", settings.store_bytes, 1'000'000'000'000, "Bytes of scenes kept, by estimate");
  add("--max-asset", settings.asset_bytes, 4'000'000'000, "Bytes of a mesh file");
  add("--max-assets", settings.asset_store_bytes, 1'000'000'000'000, "Bytes of mesh files kept");
  add("--max-connections", settings.connections, 10000, "Connections at once");
  add("--max-queue", settings.queue, 1'000'000, "Renders that wait for their turn");
  add("--max-orbits", settings.orbits, 10'000, "Different orbits streamed at once");
  add("--max-frames", settings.orbit_frames, 1'000'000, "Frames of an orbit");
  add("--max-seconds", options.request_seconds, 1'000'000, "Seconds that one picture may take");
  add("--grace", options.grace_seconds, 1'000'000, "Seconds that running requests get when the service ends");
}

}  // namespace

Command add_serve(CLI::App& root) {
  const auto options = std::make_shared<Options>();
  CLI::App* app = root.add_subcommand("serve", "Answer requests over HTTP, and show the page");
  app->footer(kExamples);
  app->add_option("--host", options->settings.host, "Name or address to listen on")->capture_default_str();
  app->add_option("--port", options->settings.port, "Port; 0: a free one")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_option(
         "--health-port", options->settings.health_port,
         "Port of /healthz, /readyz and /metrics, which answer however busy the service is; 0: a free one")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--threads", options->settings.threads, "Threads that render; 0: one a core")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
  app->add_flag("--insecure", options->insecure, "Allow an address that other machines can reach");
  app->add_flag("--quiet", options->quiet, "Log warnings and errors only");
  app->add_option("--log", options->log, "Form of the log on standard error; text on a terminal, else json")
      ->check(CLI::IsMember({"text", "json"}).description(""))
      ->type_name("text|json");
  add_limit_options(*app, *options);
  return {app, [options] { return serve(*options); }};
}

}  // namespace orrery
