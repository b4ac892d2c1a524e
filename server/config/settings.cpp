#include "server/config/settings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/number.h"

namespace orrery {
namespace {

using S = Settings;
constexpr std::int64_t kMaxLimit = 1'000'000'000'000;

constexpr std::array kSettings{
    Setting{"host", &S::host, "NAME", "Host name or address to listen on"},
    Setting{"port", &S::port, "N", "Port to listen on; 0: any free port", 0, 65535},
    Setting{"health_host", &S::health_host, "NAME", "Host name or address of health_port"},
    Setting{"health_port", &S::health_port, "N",
            "Separate port of /healthz, /readyz and /metrics, responsive under load; 0: any free port", 0,
            65535},
    Setting{"threads", &S::threads, "N", "Render threads; 0: one per core", 0, 1024},
    Setting{"tokens_file", &S::tokens_file, "FILE",
            "Access tokens, one line of `orrery token` each; reloaded on SIGHUP"},
    Setting{"link_signing_key_file", &S::link_signing_key_file, "FILE",
            "Key of at least 32 bytes that signs links (POST /v1/shares); reloaded on SIGHUP", 0, 0,
            "share_key_file"},
    Setting{"cors_origins", &S::cors_origins, "ORIGIN,...",
            "Origins whose pages may use the service; *: all. Without tokens, the service's own origin too "
            "if it is a domain"},
    Setting{
        "trusted_proxies", &S::trusted_proxies, "NETWORK,...",
        "Proxies (IP or CIDR) whose Forwarded and X-Forwarded-For, -Host and -Prefix headers are trusted"},
    Setting{"path_prefix", &S::path_prefix, "PATH",
            "Path prefix of URLs behind a proxy, such as /render; links have it, requests may have it"},
    Setting{"insecure", &S::insecure, "", "Allow other machines to connect without tokens"},
    // Limits.
    Setting{
        "memory_bytes", &S::memory_bytes, "N",
        "Memory limit in bytes; the other byte limits are parts of it, the rest (work_bytes) is for scenes "
        "and images in progress",
        160'000'000, kMaxLimit},
    Setting{"max_request_body_bytes", &S::max_request_body_bytes, "N", "Maximum bytes of a request body", 1,
            1'000'000'000, "body_bytes"},
    Setting{"request_buffer_bytes", &S::request_buffer_bytes, "N",
            "Maximum bytes of all request bodies in transfer; one client: half", 1, kMaxLimit,
            "bodies_bytes"},
    Setting{"response_buffer_bytes", &S::response_buffer_bytes, "N",
            "Maximum bytes of all responses in transfer; one client: half", 1, kMaxLimit, "answers_bytes"},
    Setting{"scene_cache_bytes", &S::scene_cache_bytes, "N",
            "Maximum bytes of cached scenes with their acceleration structures", 1, kMaxLimit, "store_bytes"},
    Setting{"asset_bytes", &S::asset_bytes, "N", "Maximum bytes of an asset (mesh or image file)", 1,
            4'000'000'000},
    Setting{"asset_store_bytes", &S::asset_store_bytes, "N", "Maximum bytes of all stored assets", 1,
            kMaxLimit},
    Setting{"image_cache_bytes", &S::image_cache_bytes, "N", "Maximum bytes of cached images", 0, kMaxLimit,
            "picture_bytes"},
    Setting{"film_cache_bytes", &S::film_cache_bytes, "N",
            "Maximum bytes of cached films, for other formats of an image; one film: a quarter", 0, kMaxLimit,
            "film_bytes"},
    Setting{"connections", &S::connections, "N",
            "Maximum open connections; streams: three quarters, streams of one client: half of these", 1,
            10'000},
    Setting{"max_concurrent_renders", &S::max_concurrent_renders, "N",
            "Maximum requests that trace rays at once (slots); 0: two per thread", 0, 1024, "renders"},
    Setting{"max_queued_rays", &S::max_queued_rays, "N",
            "Maximum estimated rays of the queued requests, per priority", 1, kMaxLimit, "queue_rays"},
    Setting{"interactive_rays", &S::interactive_rays, "N",
            "Maximum estimated rays of an image with interactive priority", 1, kMaxLimit},
    Setting{"request_rays", &S::request_rays, "N",
            "Maximum estimated rays of one image, else the request is rejected; 0: 50 million per thread and "
            "second of request_seconds",
            0, kMaxLimit},
    Setting{"max_orbit_streams", &S::max_orbit_streams, "N",
            "Maximum distinct orbits streamed at once; one client: half", 1, 10'000, "orbits"},
    Setting{"orbit_frames", &S::orbit_frames, "N", "Maximum frames of an orbit", 1, 1'000'000},
    Setting{"request_seconds", &S::request_seconds, "N", "Maximum seconds of one image", 1, 1'000'000},
    Setting{"jobs", &S::jobs, "N", "Maximum unfinished jobs; one client: half", 1, 1000},
    Setting{"max_finished_jobs", &S::max_finished_jobs, "N", "Maximum finished jobs that are kept", 1,
            1'000'000, "jobs_kept"},
    Setting{"job_bytes", &S::job_bytes, "N", "Maximum bytes of the images of all jobs", 1, kMaxLimit},
    Setting{"job_seconds", &S::job_seconds, "N", "Maximum seconds of one job", 1, 1'000'000},
    Setting{"job_kept_seconds", &S::job_kept_seconds, "N", "Seconds that a finished job is kept", 1,
            10'000'000},
    Setting{"drain_delay_seconds", &S::drain_delay_seconds, "N",
            "Seconds after SIGTERM during which work is accepted while /readyz answers draining, for load "
            "balancers",
            0, 1'000'000},
    Setting{"grace_seconds", &S::grace_seconds, "N", "Seconds for running requests to finish at shutdown", 1,
            1'000'000},
};
constexpr std::size_t kFirstLimit = 11;
static_assert(kSettings[kFirstLimit].name == "memory_bytes");

// Memory limits that are parts of memory_bytes.
constexpr std::array kBudgets{
    &S::request_buffer_bytes, &S::response_buffer_bytes, &S::scene_cache_bytes, &S::asset_store_bytes,
    &S::image_cache_bytes,    &S::film_cache_bytes,      &S::job_bytes};

std::int64_t whole_number(std::string_view text, std::int64_t min, std::int64_t max) {
  constexpr double kMaxExact = 1e15;  // 1e6 is an integer, too
  auto number = parse_number<std::int64_t>(text);
  if (const auto real = parse_number<double>(text);
      !number && real && std::trunc(*real) == *real && std::abs(*real) < kMaxExact)
    number = static_cast<std::int64_t>(*real);
  if (number && *number >= min && *number <= max) return *number;
  throw InputError("", "must be an integer from " + std::to_string(min) + " to " + std::to_string(max) +
                           " (got " + std::string(text.substr(0, 80)) + ")");
}

bool truth_value(std::string_view text) {
  constexpr std::array<std::string_view, 4> kYes{"true", "1", "yes", "on"}, kNo{"false", "0", "no", "off"};
  if (std::find(kYes.begin(), kYes.end(), text) != kYes.end()) return true;
  if (std::find(kNo.begin(), kNo.end(), text) != kNo.end()) return false;
  throw InputError("", "must be true or false (got " + std::string(text.substr(0, 80)) + ")");
}

std::vector<std::string> list_of(std::string_view text) {
  std::vector<std::string> entries;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    entries.emplace_back(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return entries;
}

struct TextOf {
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::chrono::seconds value) const { return std::to_string(value.count()); }
  std::string operator()(const std::vector<std::string>& list) const {
    std::string all;
    for (const std::string& entry : list) all += (all.empty() ? "" : ",") + entry;
    return all;
  }
  std::string operator()(double value) const { return std::to_string(static_cast<std::int64_t>(value)); }
  std::string operator()(int value) const { return std::to_string(value); }
  std::string operator()(std::size_t value) const { return std::to_string(value); }
};

}  // namespace

Settings settings_within(std::size_t memory_bytes) {
  Settings settings;
  const double part = static_cast<double>(memory_bytes) / static_cast<double>(settings.memory_bytes);
  settings.memory_bytes = memory_bytes;
  for (const auto budget : kBudgets)
    settings.*budget = static_cast<std::size_t>(static_cast<double>(settings.*budget) * part);
  settings.max_request_body_bytes = std::min(settings.max_request_body_bytes, settings.request_buffer_bytes);
  settings.asset_bytes =
      std::min({settings.asset_bytes, settings.asset_store_bytes, settings.request_buffer_bytes});
  return settings;
}

std::size_t work_bytes(const Settings& settings) {
  constexpr std::size_t kProgram = 32 << 20, kConnection = 64 << 10, kLeast = 16 << 20;
  const std::size_t one_body = std::max(settings.max_request_body_bytes, settings.asset_bytes);
  std::size_t others = kProgram + settings.connections * kConnection;
  if (one_body > settings.request_buffer_bytes)
    others += one_body - settings.request_buffer_bytes;  // one always fits
  for (const auto budget : kBudgets) others += settings.*budget;
  if (settings.memory_bytes >= others + kLeast) return settings.memory_bytes - others;
  throw InputError("", "memory_bytes must be at least " + std::to_string(others + kLeast) +
                           ": other budgets, " + std::to_string(settings.connections) +
                           " connections and the program take " + std::to_string(others) +
                           ", and requests need " + std::to_string(kLeast) + " (got " +
                           std::to_string(settings.memory_bytes) + ")");
}

std::span<const Setting> all_settings() { return kSettings; }
std::span<const Setting> limits() { return all_settings().subspan(kFirstLimit); }

std::string Setting::text(const Settings& settings) const {
  return std::visit([&](auto field) { return TextOf()(settings.*field); }, member);
}

void Setting::read(Settings& settings, std::string_view text) const {
  std::visit(
      [&](auto field) {
        auto& target = settings.*field;
        using Value = std::decay_t<decltype(target)>;
        if constexpr (std::is_same_v<Value, std::string>)
          target = text;
        else if constexpr (std::is_same_v<Value, std::vector<std::string>>)
          target = list_of(text);
        else if constexpr (std::is_same_v<Value, bool>)
          target = truth_value(text);
        else
          target = Value(whole_number(text, min, max));
      },
      member);
}

}  // namespace orrery
