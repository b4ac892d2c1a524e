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

// What the service may use, and how it is reached.
struct Settings {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::string health_host = "127.0.0.1";
  int health_port = 8081;  // of /healthz, /readyz and /metrics, for supervisors
  int threads = 0;         // that render; 0: one a core

  // Limits; see limits().
  std::size_t memory_bytes = std::size_t{3} << 30;
  std::size_t body_bytes = 8 << 20;
  std::size_t bodies_bytes = 256 << 20;
  std::size_t answers_bytes = 256 << 20;
  std::size_t store_bytes = 256 << 20;
  std::size_t asset_bytes = 64 << 20;
  std::size_t asset_store_bytes = 256 << 20;
  std::size_t picture_bytes = 64 << 20;
  std::size_t film_bytes = 128 << 20;
  std::size_t connections = 256;
  int renders = 0;
  double queue_rays = 300e6;
  double interactive_rays = 50e6;
  double request_rays = 0;
  int orbits = 64;
  int orbit_frames = 3600;
  std::chrono::seconds request_seconds{60};
  int jobs = 32;
  int jobs_kept = 1000;
  std::size_t job_bytes = 512 << 20;
  std::chrono::seconds job_seconds{3600};
  std::chrono::seconds job_kept_seconds{3600};
  std::chrono::seconds drain_delay_seconds{0};
  std::chrono::seconds grace_seconds{30};

  // Who may ask; empty: everyone who can.
  bool insecure = false;  // also from other machines
  std::string tokens_file, share_key_file;
  std::vector<std::string> cors_origins;

  // What stands in front of it.
  std::vector<std::string> trusted_proxies;
  std::string path_prefix;
};

// One setting, under the one name that flags (--body-bytes), environment (ORRERY_BODY_BYTES), files,
// /v1/limits and errors use.
struct Setting {
  using Member = std::variant<std::size_t Settings::*, int Settings::*, double Settings::*,
                              std::chrono::seconds Settings::*, bool Settings::*, std::string Settings::*,
                              std::vector<std::string> Settings::*>;
  std::string_view name;
  Member member;
  std::string_view value;  // what the help calls its value
  std::string_view help;
  std::int64_t min = 0, max = 0;  // of a number; numbers are whole

  // The value as read() takes it; the entries of a list have commas between them.
  std::string text(const Settings& settings) const;
  // Throws InputError without a place for a text that is no value of it.
  void read(Settings& settings, std::string_view text) const;
};

// The settings as they are if only memory_bytes is given: the other budgets are as large a part of it as by
// default.
Settings settings_within(std::size_t memory_bytes);

// Bytes that work may hold: what memory_bytes leaves beside the other budgets and what the service itself
// takes. Throws InputError without a place if that is too little for a picture.
std::size_t work_bytes(const Settings& settings);

// All of them; and those that /v1/limits tells, which are numbers.
std::span<const Setting> all_settings();
std::span<const Setting> limits();

}  // namespace orrery
