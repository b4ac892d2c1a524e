#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace orrery {

// Configuration of the service.
struct Settings {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::string health_host = "127.0.0.1";
  int health_port = 8081;  // serves /healthz, /readyz and /metrics, for supervisors
  int threads = 0;         // render threads; 0: one per core

  // Limits; see limits().
  std::size_t memory_bytes = std::size_t{3} << 30;
  std::size_t max_request_body_bytes = 8 << 20;
  std::size_t request_buffer_bytes = 256 << 20;
  std::size_t response_buffer_bytes = 256 << 20;
  std::size_t scene_cache_bytes = 256 << 20;
  std::size_t asset_bytes = 64 << 20;
  std::size_t asset_store_bytes = 256 << 20;
  std::size_t image_cache_bytes = 64 << 20;
  std::size_t film_cache_bytes = 128 << 20;
  std::size_t connections = 256;
  int max_concurrent_renders = 0;
  double max_queued_rays = 300e6;
  double interactive_rays = 50e6;
  double request_rays = 0;
  int max_orbit_streams = 64;
  int orbit_frames = 3600;
  std::chrono::seconds request_seconds{60};
  int jobs = 32;
  int max_finished_jobs = 1000;
  std::size_t job_bytes = 512 << 20;
  std::chrono::seconds job_seconds{3600};
  std::chrono::seconds job_kept_seconds{3600};
  std::chrono::seconds drain_delay_seconds{0};
  std::chrono::seconds grace_seconds{30};

  // Access control. Empty values allow every client that can connect.
  bool insecure = false;  // allow other machines without tokens
  std::string tokens_file, link_signing_key_file;
  std::vector<std::string> cors_origins;

  // Reverse proxy.
  std::vector<std::string> trusted_proxies;
  std::string path_prefix;
};

// Setting with one name for flags (--max-request-body-bytes), environment (ORRERY_MAX_REQUEST_BODY_BYTES),
// files, /v1/limits and error messages.
struct Setting {
  using Member = std::variant<std::size_t Settings::*, int Settings::*, double Settings::*,
                              std::chrono::seconds Settings::*, bool Settings::*, std::string Settings::*,
                              std::vector<std::string> Settings::*>;
  std::string_view name;
  Member member;
  std::string_view value;  // placeholder for the value in the help
  std::string_view help;
  std::int64_t min = 0, max = 0;  // range of a number, which must be an integer
  std::string_view former = "";   // name that stays valid as an alias, except in /v1/limits

  // Returns the value in the format of read(). List entries are separated by commas.
  std::string text(const Settings& settings) const;
  // Parses the value. Throws InputError with an empty pointer if the text is invalid.
  void read(Settings& settings, std::string_view text) const;
};

// Returns the settings if only memory_bytes is given. The other memory limits have the same share of it as by
// default.
Settings settings_within(std::size_t memory_bytes);

// Returns the bytes that work may hold: memory_bytes minus the other memory limits and the needs of the
// service itself. Throws InputError with an empty pointer if the rest is too small for an image.
std::size_t work_bytes(const Settings& settings);

// Returns all settings, or only the limits that /v1/limits reports, which are numbers.
std::span<const Setting> all_settings();
std::span<const Setting> limits();

}  // namespace orrery
