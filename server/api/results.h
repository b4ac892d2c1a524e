#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/budget/renderer.h"
#include "server/http/message.h"

// Table of the results of a rendered image, one row per result. The following derive from it: headers of
// responses and of multipart parts, JSON of stream frames, of job steps and of --stats=json, lines of
// --stats, exposed headers (CORS) and OpenAPI. All functions are thread-safe.
namespace orrery {

// Cost of a render command.
struct CommandCost {
  int threads = 0;
  double load_ms = 0, encode_ms = 0;
  double render_cpu_s = 0;  // CPU time of building and tracing, without loading and encoding
};

// Data that the rows read. Null, nullopt and empty: unknown, or no such result.
struct ImageResults {
  const Plan* plan = nullptr;
  const RenderStats* stats = nullptr;
  const Certificate* certificate = nullptr;
  const BudgetOutcome* budget = nullptr;
  std::span<const Problem> warnings = {};
  std::optional<int> samples = {};         // per pixel, after a pass
  std::optional<std::uint64_t> rays = {};  // traced for a response, a pass or a frame
  const CommandCost* cost = nullptr;
};
// Returns statistics, certificate and budget of the render, which must outlive the returned object.
ImageResults results_of(const RenderResult& rendered);

// Outputs that show results.
struct ResultOutputs {
  bool image = true;                                 // headers of the response with an image
  bool refinement_part = true, orbit_part = true;    // headers of a multipart part
  bool refinement_frame = true, orbit_frame = true;  // JSON header of a frame
  bool job_step = true;                              // JSON of a job's finished image
  bool stats = true;                                 // JSON and lines of --stats
};
using ResultOutput = bool ResultOutputs::*;

// Row of the table. Each function returns "" or null if the result is missing.
struct ImageResult {
  using Text = std::string (*)(const ImageResults&);
  using Json = nlohmann::ordered_json (*)(const ImageResults&);

  ResultOutputs in = {};
  std::string_view description = {};  // for OpenAPI; without a full stop

  std::string_view header = {};             // name of the header; empty: none
  std::string_view former_header = {};      // name for clients of version 0.1; empty: none
  std::string_view header_type = "string";  // JSON Schema type of its value
  Text text = nullptr;                      // value of the header; null: JSON of the member

  std::string_view member = {};        // name of the JSON member; empty: none
  std::string_view stats_member = {};  // name in --stats=json if it differs
  std::string_view member_type = {};   // JSON Schema type
  Json json = nullptr;

  std::string_view label = {};  // label of the line of --stats; empty: none
  Text line = nullptr;          // text of the line; null: none
};

// Returns all rows, in the order of the lines of --stats.
std::span<const ImageResult> image_results();

// Returns the headers of an output, each followed by its former name if it has one.
Fields result_headers(ResultOutput output, const ImageResults& results);
// Returns the names of all headers that result_headers() can return.
std::vector<std::string_view> result_header_names(ResultOutput output);
// Returns the JSON members of an output. REQUIRES for `stats`: plan, stats, certificate and cost are set.
nlohmann::ordered_json result_members(ResultOutput output, const ImageResults& results);
// Returns the lines of --stats. REQUIRES: plan, stats, certificate and cost are set.
std::string result_lines(const ImageResults& results);

}  // namespace orrery
