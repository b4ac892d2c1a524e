#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace orrery {

// What the service may use. /v1/limits publishes the limits, and the errors name them.
struct Settings {
  std::string host = "127.0.0.1";
  int port = 8080;
  int health_port = 8081;                     // of /healthz, /readyz and /metrics, for supervisors
  int threads = 0;                            // that render; 0: one a core
  std::size_t body_bytes = 8 << 20;           // of a request
  std::size_t bodies_bytes = 256 << 20;       // of all requests at one time
  std::size_t store_bytes = 256 << 20;        // of scenes kept, by estimate
  std::size_t asset_bytes = 64 << 20;         // of a mesh file
  std::size_t asset_store_bytes = 256 << 20;  // of mesh files kept
  std::size_t connections = 256;
  int renders = 0;  // at once; 0: two a core
  int queue = 64;   // renders that wait for their turn
  int orbits = 32;  // different ones streamed at once
  int orbit_frames = 3600;
  std::chrono::seconds request_time{60};  // for one picture
  std::chrono::seconds grace{30};         // for running requests when the service ends
};

}  // namespace orrery
