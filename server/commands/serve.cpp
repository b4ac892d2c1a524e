#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <mutex>

#include "core/base/version.h"
#include "core/math/instruction_level.h"
#include "server/commands/commands.h"
#include "server/commands/config.h"
#include "server/commands/signals.h"
#include "server/http/listener.h"
#include "server/service.h"

namespace orrery {
namespace {

constexpr const char* kExamples = R"(
Examples:
  orrery serve                                     then open http://127.0.0.1:8080
  orrery serve --port 0                            any free port; the first line printed says which
  orrery serve --config orrery.json                settings by their names: {"port": 80, "body_bytes": 1000000}
  curl --data-binary @scenes/paper.json http://127.0.0.1:8080/v1/render -o paper.png

A setting comes from its flag, or else its variable (ORRERY_PORT), or else the file, or else is as shown.
SIGTERM or Ctrl-C ends it: running requests are answered, streams stop after a frame. A second one ends it at once.
SIGHUP reads the files of tokens and keys again.
)";

struct Options {
  Settings settings;
  bool quiet = false, check_config = false, print_config = false;
  std::string config, log = isatty(STDERR_FILENO) ? "text" : "json";
};

void require_sense(const Settings& settings) {
  if (settings.port == settings.health_port && settings.port != 0)
    throw InputError("--health-port", "is the same as --port, " + std::to_string(settings.port));
  if (settings.insecure || !settings.tokens_file.empty() || is_loopback(settings.host)) return;
  throw InputError("--host",
                   settings.host +
                       " can be reached from other machines, and everyone who reaches it may render; "
                       "give --tokens-file, or --insecure if that is meant");
}

void announce(const Service& service, const Settings& settings) {
  const bool v6 = settings.host.find(':') != std::string::npos;
  std::cout << "orrery listens on http://" << (v6 ? "[" + settings.host + "]" : settings.host) << ":"
            << service.port() << "\nhealth and metrics on port " << service.health_port() << std::endl;
}

int run_service(const Settings& settings, const Log& log) {
  // The signals are taken before the service starts threads; it learns of them once it is there.
  std::mutex mutex;
  Service* running = nullptr;  // guarded by mutex
  const auto tell = [&](void (Service::*what)()) {
    const std::lock_guard lock(mutex);
    if (running) (running->*what)();
  };
  const SignalWatch signals([&] { tell(&Service::stop); }, [&] { tell(&Service::reload); });
  Service service(settings, log);
  {
    const std::lock_guard lock(mutex);
    running = &service;
    if (signals.interrupted().stop_requested()) service.stop();
  }
  announce(service, settings);
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

int serve(CLI::App& app, const Options& options) {
  if (!options.config.empty()) read_config_file(app, options.config);
  const Settings& settings = options.settings;
  require_sense(settings);
  if (options.print_config) std::cout << config_text(app);
  if (options.check_config) const Access access(settings.tokens_file, settings.share_key_file);
  if (options.print_config || options.check_config) return kDone;
  const Log log(options.log == "json" ? LogForm::json : LogForm::text,
                options.quiet ? LogLevel::warning : LogLevel::info);
  return run_service(settings, log);
}

}  // namespace

Command add_serve(CLI::App& root) {
  const auto options = std::make_shared<Options>();
  CLI::App* app = root.add_subcommand("serve", "Answer requests over HTTP, and show the page");
  app->footer(kExamples);
  app->add_option("--config", options->config, "JSON file of settings")->type_name("FILE");
  app->add_flag("--check-config", options->check_config, "Say what is wrong with the settings, and end");
  app->add_flag("--print-config", options->print_config,
                "Print all settings as a file for --config, and end");
  app->add_flag("--quiet", options->quiet, "Log warnings and errors only");
  app->add_option("--log", options->log, "Form of the log on standard error; text on a terminal, else json")
      ->check(CLI::IsMember({"text", "json"}).description(""))
      ->type_name("text|json");
  add_settings(*app, options->settings);
  return {app, [app, options] { return serve(*app, *options); }};
}

}  // namespace orrery
