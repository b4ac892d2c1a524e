#include "server/app/settings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/number.h"

namespace orrery {
namespace {

using S = Settings;
constexpr std::int64_t kMost = 1'000'000'000'000;

constexpr std::array kSettings{
    Setting{"host", &S::host, "NAME", "Name or address to listen on"},
    Setting{"port", &S::port, "N", "Port; 0: a free one", 0, 65535},
    Setting{"health_host", &S::health_host, "NAME", "Name or address that health_port is on"},
    Setting{"health_port", &S::health_port, "N",
            "Port of /healthz, /readyz and /metrics, which answer however busy the service is; 0: a free one",
            0, 65535},
    Setting{"threads", &S::threads, "N", "Threads that render; 0: one a core", 0, 1024},
    Setting{"tokens_file", &S::tokens_file, "FILE",
            "Who may use the service: lines of `orrery token`; read again on SIGHUP"},
    Setting{"share_key_file", &S::share_key_file, "FILE",
            "At least 32 secret bytes that links are signed with (POST /v1/shares); read again on SIGHUP"},
    Setting{"cors_origins", &S::cors_origins, "ORIGIN,...",
            "Origins whose pages may use the service, also its own if that is a domain and there are no "
            "tokens; * for all"},
    Setting{"trusted_proxies", &S::trusted_proxies, "NETWORK,...",
            "Addresses and networks of proxies, which are believed who asks, of which host and below which "
            "path: Forwarded, X-Forwarded-For, -Host and -Prefix"},
    Setting{"path_prefix", &S::path_prefix, "PATH",
            "What addresses begin with for clients, such as /render; links begin with it, and requests may"},
    Setting{"insecure", &S::insecure, "", "Allow an address that other machines can reach without tokens"},
    // Limits.
    Setting{
        "memory_bytes", &S::memory_bytes, "N",
        "Bytes of memory that the service takes; the other budgets are parts of it, and what they leave is "
        "for scenes and pictures under way (work_bytes)",
        160'000'000, kMost},
    Setting{"body_bytes", &S::body_bytes, "N", "Bytes of a request's body", 1, 1'000'000'000},
    Setting{"bodies_bytes", &S::bodies_bytes, "N",
            "Bytes of the bodies of all requests at one time; half of them for one client", 1, kMost},
    Setting{"answers_bytes", &S::answers_bytes, "N",
            "Bytes of all answers that are sent at one time; half of them for one client", 1, kMost},
    Setting{"store_bytes", &S::store_bytes, "N", "Bytes of scenes kept, with what was built for them", 1,
            kMost},
    Setting{"asset_bytes", &S::asset_bytes, "N", "Bytes of a mesh file", 1, 4'000'000'000},
    Setting{"asset_store_bytes", &S::asset_store_bytes, "N", "Bytes of mesh files kept", 1, kMost},
    Setting{"picture_bytes", &S::picture_bytes, "N", "Bytes of pictures kept for who asks again", 0, kMost},
    Setting{"film_bytes", &S::film_bytes, "N",
            "Bytes of films kept for who asks for another format; one may take a quarter", 0, kMost},
    Setting{"connections", &S::connections, "N",
            "Connections at once; streams may have three quarters of them, one client half of these", 1,
            10'000},
    Setting{"renders", &S::renders, "N", "Pieces of work at once; 0: two a thread", 0, 1024},
    Setting{"queue_rays", &S::queue_rays, "N", "Expected rays of what waits for its turn, in each lane", 1,
            kMost},
    Setting{"interactive_rays", &S::interactive_rays, "N",
            "Expected rays of one picture, beyond which it takes its turn among the long work", 1, kMost},
    Setting{"request_rays", &S::request_rays, "N",
            "Expected rays of one picture, beyond which a request for it is refused at once; 0: 50 million a "
            "thread and second of request_seconds",
            0, kMost},
    Setting{"orbits", &S::orbits, "N", "Different orbits streamed at once; half of them for one client", 1,
            10'000},
    Setting{"orbit_frames", &S::orbit_frames, "N", "Frames of an orbit", 1, 1'000'000},
    Setting{"request_seconds", &S::request_seconds, "N", "Seconds that one picture may take", 1, 1'000'000},
    Setting{"jobs", &S::jobs, "N", "Jobs under way at once; half of them for one client", 1, 1000},
    Setting{"jobs_kept", &S::jobs_kept, "N", "Jobs that are kept after their end", 1, 1'000'000},
    Setting{"job_bytes", &S::job_bytes, "N", "Bytes of the pictures of all jobs", 1, kMost},
    Setting{"job_seconds", &S::job_seconds, "N", "Seconds that one job may take", 1, 1'000'000},
    Setting{"job_kept_seconds", &S::job_kept_seconds, "N", "Seconds that a job is kept after its end", 1,
            10'000'000},
    Setting{
        "drain_delay_seconds", &S::drain_delay_seconds, "N",
        "Seconds that the service goes on taking work after it was told to end, while /readyz says that it "
        "does not: for a balancer to notice",
        0, 1'000'000},
    Setting{"grace_seconds", &S::grace_seconds, "N",
            "Seconds that running requests get when the service ends", 1, 1'000'000},
};
constexpr std::size_t kFirstLimit = 11;
static_assert(kSettings[kFirstLimit].name == "memory_bytes");

// Memory limits that are parts of memory_bytes.
constexpr std::array kBudgets{&S::bodies_bytes,  &S::answers_bytes, &S::store_bytes, &S::asset_store_bytes,
                              &S::picture_bytes, &S::film_bytes,    &S::job_bytes};

std::int64_t whole_number(std::string_view text, std::int64_t min, std::int64_t max) {
  constexpr double kMaxExact = 1e15;  // 1e6 is an integer, too
  auto number = parse_number<std::int64_t>(text);
  if (const auto real = parse_number<double>(text);
      !number && real && std::trunc(*real) == *real && std::abs(*real) < kMaxExact)
    number = static_cast<std::int64_t>(*real);
  if (number && *number >= min && *number <= max) return *number;
  throw InputError("", "expected a whole number from " + std::to_string(min) + " to " + std::to_string(max) +
                           ", got " + std::string(text.substr(0, 80)));
}

bool truth_value(std::string_view text) {
  constexpr std::array<std::string_view, 4> kYes{"true", "1", "yes", "on"}, kNo{"false", "0", "no", "off"};
  if (std::find(kYes.begin(), kYes.end(), text) != kYes.end()) return true;
  if (std::find(kNo.begin(), kNo.end(), text) != kNo.end()) return false;
  throw InputError("", "expected true or false, got " + std::string(text.substr(0, 80)));
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
  settings.body_bytes = std::min(settings.body_bytes, settings.bodies_bytes);
  settings.asset_bytes = std::min({settings.asset_bytes, settings.asset_store_bytes, settings.bodies_bytes});
  return settings;
}

std::size_t work_bytes(const Settings& settings) {
  constexpr std::size_t kProgram = 32 << 20, kConnection = 64 << 10, kLeast = 16 << 20;
  const std::size_t one_body = std::max(settings.body_bytes, settings.asset_bytes);
  std::size_t others = kProgram + settings.connections * kConnection;
  if (one_body > settings.bodies_bytes) others += one_body - settings.bodies_bytes;  // one always fits
  for (const auto budget : kBudgets) others += settings.*budget;
  if (settings.memory_bytes >= others + kLeast) return settings.memory_bytes - others;
  throw InputError("", "memory_bytes is " + std::to_string(settings.memory_bytes) +
                           ", but the other budgets, " + std::to_string(settings.connections) +
                           " connections and the program take " + std::to_string(others) + ", and at least " +
                           std::to_string(kLeast) + " more are needed for work");
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
