#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>
#include <thread>

#include "core/base/shorten.h"
#include "core/base/version.h"
#include "core/math/instruction_level.h"
#include "server/commands/commands.h"
#include "server/commands/config.h"
#include "server/commands/signals.h"
#include "server/http/authority.h"
#include "server/http/forwarding.h"
#include "server/http/listener.h"
#include "server/http/process_limits.h"
#include "server/service/service.h"

namespace orrery {
namespace {

constexpr const char* kServeExamples = R"(
Examples:
  orrery serve                          # page on http://127.0.0.1:8080
  orrery serve --port 0                 # a free port, printed on the first line
  orrery serve --config orrery.json     # {"max_request_body_bytes": 1000000}
  curl --data-binary @scenes/paper.json http://127.0.0.1:8080/v1/render -o a.png

A setting comes from its option (--port), else from its environment variable
(ORRERY_PORT), else from the file, else from its default. Unknown names are
errors, except ORRERY_TOKEN, which clients use.
All data is in memory and lost when the service stops.
SIGTERM or Ctrl-C stops the service after --drain-delay-seconds: running
requests finish, streams end after a frame. A second signal exits at once.
SIGHUP reloads tokens, keys and cors_origins. The log lists other changed
settings, which need a restart.
)";

struct ServeOptions {
  bool quiet = false, check_config = false, print_config = false;
  std::string config, log = isatty(STDERR_FILENO) ? "text" : "json";
};

// Appends the errors that read_settings() cannot detect: conflicts between settings, and malformed origins,
// networks and prefixes.
void check_values(const Settings& settings, std::vector<Problem>& problems) {
  const auto note = [&](const char* flag, const auto& read) {
    try {
      read();
    } catch (const InputError& error) {
      problems.push_back({flag, error.what()});
    }
  };
  if (settings.port == settings.health_port && settings.port != 0)
    problems.push_back(
        {"--health-port", "must differ from --port (got " + std::to_string(settings.port) + ")"});
  for (const std::string& origin : settings.cors_origins)
    if (origin != "*" && origin != "null" && !is_origin(origin))
      problems.push_back(
          {"--cors-origins",
           "must be *, null or origins such as https://app.example:8443 (got " + origin.substr(0, 80) + ")"});
  for (const std::string& proxy : settings.trusted_proxies)
    note("--trusted-proxies", [&] { IpNetwork{proxy}; });
  note("--path-prefix", [&] { Forwarding({}, settings.path_prefix); });
  for (const std::string_view own : {"/v1/", "/scenes/", "/schemas/", "/healthz/", "/readyz/"})
    if ((settings.path_prefix + "/").starts_with(own))
      problems.push_back(
          {"--path-prefix", "must not be a path of the service itself (got " + settings.path_prefix + ")"});
  note("--memory-bytes", [&] { work_bytes(settings); });
}

// Appends errors of the environment: a host that other machines can reach although no token is required, and
// process limits that are too low for these settings.
void check_environment(const Settings& settings, std::vector<Problem>& problems) {
  try {
    if (!settings.insecure && settings.tokens_file.empty() && !is_loopback(settings.host))
      problems.push_back({"--host", settings.host +
                                        " can be reached from other machines, so anyone could render; "
                                        "set --tokens-file, or --insecure to allow it"});
  } catch (const Error& error) {  // the host cannot be resolved
    problems.push_back({"--host", error.what()});
  }
  const std::size_t threads =
      settings.threads > 0 ? static_cast<std::size_t>(settings.threads) : std::thread::hardware_concurrency();
  const std::size_t addresses = settings.memory_bytes + addresses_for(settings.connections, threads);
  if (const std::size_t allowed = allowed_addresses(); allowed < addresses)
    problems.push_back({"--memory-bytes", grouped(settings.memory_bytes) + " bytes, " +
                                              std::to_string(settings.connections) + " connections and " +
                                              std::to_string(threads) + " threads may need " +
                                              grouped(addresses) + " bytes of address space (limit " +
                                              grouped(allowed) + ", ulimit -v)"});
  const std::size_t needed = descriptors_for(settings.connections), allowed = allow_descriptors(needed);
  if (allowed < needed)
    problems.push_back({"--connections", std::to_string(settings.connections) + " connections may need " +
                                             grouped(needed) + " open files (limit " + grouped(allowed) +
                                             ", ulimit -n)"});
}

// Returns the number of tokens. Appends the errors of the token and key files.
std::size_t count_tokens(const Settings& settings, std::vector<Problem>& problems) try {
  return Access(settings.tokens_file, settings.link_signing_key_file).tokens();
} catch (const InputError& error) {
  problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  return 0;
}

void announce(const Service& service, const Settings& settings, const Log& log) {
  const bool v6 = settings.host.find(':') != std::string::npos;
  std::cout << "orrery listens on http://" << (v6 ? "[" + settings.host + "]" : settings.host) << ":"
            << service.port() << "\nhealth and metrics on port " << service.health_port() << std::endl;
  if (std::cout) return;
  log.write(LogLevel::warning, "cannot write to standard output", nlohmann::ordered_json::object());
  std::cout.clear();  // the service continues without it
}

// `read`: returns the settings at the time of the call.
int run_service(const Settings& settings, LogForm form, LogLevel level,
                const std::function<Settings()>& read) {
  // SignalWatch blocks the signals before the log and the service start threads. The callbacks do nothing
  // until the service exists.
  std::mutex mutex;
  Service* running = nullptr;  // guarded by mutex
  const auto tell = [&](const auto& what) {
    const std::lock_guard lock(mutex);
    if (running) what(*running);
  };
  const SignalWatch signals([&] { tell([](Service& service) { service.stop(); }); },
                            [&] { tell([&](Service& service) { service.reload(read); }); });
  const Log log(form, level);
  Service service(settings, log);
  {
    const std::lock_guard lock(mutex);
    running = &service;
    if (signals.interrupted().stop_requested()) service.stop();
  }
  announce(service, settings, log);
  log.write(LogLevel::info, "start",
            {{"version", kVersion},
             {"instructions", instruction_level()},
             {"port", service.port()},
             {"storage", "in memory only, lost when the service stops"}});
  service.run();
  {
    const std::lock_guard lock(mutex);
    running = nullptr;
  }
  log.write(LogLevel::info, "end", nlohmann::ordered_json::object());
  return kDone;
}

int serve(const CLI::App& app, const ServeOptions& options) {
  signal(SIGPIPE, SIG_IGN);  // the reader of the log may exit first
  std::vector<Problem> problems;
  const Settings settings = read_settings(app, options.config, problems);
  check_values(settings, problems);
  check_environment(settings, problems);
  const std::size_t tokens = count_tokens(settings, problems);
  if (options.log != "json" && options.log != "text")
    problems.push_back({"--log", "must be text or json (got " + options.log.substr(0, 80) + ")"});
  if (!problems.empty()) throw InputError(std::move(problems));
  if (options.print_config) std::cout << config_text(settings);
  if (options.check_config && !settings.tokens_file.empty())
    std::cout << settings.tokens_file << ": " << tokens << " tokens\n";
  if (options.print_config || options.check_config) return kDone;
  const LogForm form = options.log == "json" ? LogForm::json : LogForm::text;
  const LogLevel level = options.quiet ? LogLevel::warning : LogLevel::info;
  return run_service(settings, form, level, [&] {
    // A pipe cannot be read again, and reading could block.
    if (!options.config.empty() && !std::filesystem::is_regular_file(options.config)) return settings;
    std::vector<Problem> found;
    const Settings fresh = read_settings(app, options.config, found);
    check_values(fresh, found);
    if (!found.empty()) throw InputError(std::move(found));
    return fresh;
  });
}

}  // namespace

Command add_serve(CLI::App& root) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* app = root.add_subcommand("serve", "Run the HTTP service and its web page");
  app->footer(kServeExamples);
  app->add_option("--config", options->config, "Settings file (JSON)")->type_name("FILE");
  app->add_flag("--check-config", options->check_config, "Report all errors of the settings and exit");
  app->add_flag("--print-config", options->print_config,
                "Print all settings as a file for --config and exit");
  app->add_flag("--quiet", options->quiet, "Log warnings and errors only");
  app->add_option("--log", options->log,
                  "Format of the log on standard error (default: text on a terminal, else json)")
      ->type_name("text|json");
  add_setting_flags(*app);
  return {app, [app, options] { return serve(*app, *options); }};
}

}  // namespace orrery
