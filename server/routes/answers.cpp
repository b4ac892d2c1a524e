#include "server/routes/answers.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "server/api/frame_path.h"
#include "server/api/render_options.h"
#include "server/http/field_list.h"

namespace orrery {
namespace {

// Returns the JSON Pointer of a query parameter, such as "/azimuth" (RFC 6901).
std::string pointer_to(std::string_view name) {
  std::string pointer = "/";
  for (const char c : name.substr(0, 100)) {
    if (c == '~')
      pointer += "~0";
    else if (c == '/')
      pointer += "~1";
    else
      pointer += c;
  }
  return pointer;
}

// Throws InputError if there are query parameters, which would otherwise be ignored silently.
void require_no_query(const Request& request) {
  if (!request.query.empty())
    throw InputError(pointer_to(request.query.begin()->first),
                     "query parameters cannot be used with a JSON body; put options in the body");
}

void require_json(const Request& request) {
  refuse_compressed(request);
  require_no_query(request);
  const std::string header = request.header("Content-Type").value_or("");
  const std::string_view type = trimmed(std::string_view(header).substr(0, header.find(';')));
  // curl and HTML forms send x-www-form-urlencoded by default; such a body is also read as JSON.
  constexpr std::array<std::string_view, 4> kTypes{"", "application/json",
                                                   "application/x-www-form-urlencoded", "text/plain"};
  const bool known =
      std::any_of(kTypes.begin(), kTypes.end(), [&](auto t) { return equal_ignoring_case(t, type); });
  if (!known && !(type.starts_with("application/") && type.ends_with("+json")))
    throw HttpError(415,
                    "Content-Type must be application/json (got " + std::string(type.substr(0, 100)) + ")");
  const std::string_view charset = parameter_of(header, "charset");
  if (!charset.empty() && !equal_ignoring_case(charset, "utf-8") && !equal_ignoring_case(charset, "us-ascii"))
    throw HttpError(415, "charset of JSON must be utf-8 (got " + std::string(charset.substr(0, 40)) + ")");
}

// Match of a media type with an entry of an Accept header, such as "image/*;q=0.5". `weight`: q value, [0,
// 1].
struct Fit {
  int exactness = -1;  // 2: the type itself, 1: image/*, 0: */*, -1: no match
  double weight = 0;
};
Fit fit_of(std::string_view entry, std::string_view type) {
  const std::string_view range = trimmed(entry.substr(0, entry.find(';')));
  Fit fit;
  if (equal_ignoring_case(range, type))
    fit.exactness = 2;
  else if (range == "*/*")
    fit.exactness = 0;
  else if (range.ends_with("/*") &&
           equal_ignoring_case(range.substr(0, range.size() - 1), type.substr(0, type.find('/') + 1)))
    fit.exactness = 1;
  if (fit.exactness < 0) return fit;
  fit.weight = weight_of(entry);
  return fit;
}

}  // namespace

Caller caller_of(const Request& request) { return {request.client, request.gone}; }

RouteBody json_body(const App& app) {
  return {.limit = {app.settings().max_request_body_bytes, "max_request_body_bytes"},
          .require = require_json};
}

void refuse_compressed(const Request& request) {
  if (request.header("Content-Encoding"))
    throw HttpError(415, "request body must not be compressed (Content-Encoding)");
}

RenderRequest read_query(const Request& request, std::span<const std::string_view> more) {
  return read_option_texts(option_texts(request.query, pointer_to, more));
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text.substr(0, 40)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool has_current(const Request& request, std::string_view etag) {
  bool found = false;
  for_each_entry(joined(request.headers, "If-None-Match"), ',', [&](std::string_view known) {
    if (known.starts_with("W/")) known.remove_prefix(2);
    found = found || known == etag || known == "*";
  });
  return found;
}

std::string_view negotiate(const Request& request, std::span<const std::string_view> offered) {
  const std::string header = joined(request.headers, "Accept");
  if (trimmed(header).empty()) return offered[0];
  std::string_view best;
  double best_weight = 0;
  for (const std::string_view type : offered) {
    Fit closest;
    for_each_entry(header, ',', [&](std::string_view entry) {
      const Fit fit = fit_of(entry, type);
      if (fit.exactness > closest.exactness) closest = fit;
    });
    if (closest.weight > best_weight) {
      best = type;
      best_weight = closest.weight;
    }
  }
  if (!best.empty()) return best;
  std::string all;
  for (const std::string_view type : offered) all += (all.empty() ? "" : " or ") + std::string(type);
  throw HttpError(406, "Accept must allow " + all);
}

std::string server_timing(const Timing& timing) {
  std::string text;
  const auto add = [&](const char* name, double milliseconds) {
    if (milliseconds == 0) return;
    char entry[64];
    std::snprintf(entry, sizeof entry, "%s%s;dur=%.3f", text.empty() ? "" : ", ", name, milliseconds);
    text += entry;
  };
  add("queue", timing.queue);
  add("load", timing.load);
  add("plan", timing.plan);
  add("build", timing.build);
  add("render", timing.render);
  add("encode", timing.encode);
  return text;
}

ImageResults results_of(const Picture& picture) {
  return {.stats = &picture.stats,
          .certificate = &picture.certificate,
          .budget = picture.budget ? &*picture.budget : nullptr,
          .warnings = picture.warnings};
}

void set_results(Response& response, const ImageResults& results) {
  for (auto& [name, value] : result_headers(&ResultOutputs::image, results))
    response.set(name, std::move(value));
}

Response picture_response(std::string_view type, const Rendered& rendered, const RequestTrace& trace) {
  Response response = text_response(200, type, {rendered.picture, rendered.picture->bytes});
  ImageResults results = results_of(*rendered.picture);
  std::string told = server_timing(trace.timing);
  if (!told.empty()) told += ", ";
  if (rendered.made_now) {
    const RenderStats& stats = rendered.picture->stats;
    const AcceleratorCounts& work = stats.counts.accelerator;
    char text[320];
    std::snprintf(
        text, sizeof text,
        "structure;desc=\"%s, %zu bytes, depth %d\", work;desc=\"%llu visits, %llu boxes, %llu primitives\"",
        stats.accelerator->name, stats.structure.bytes, stats.structure.depth,
        static_cast<unsigned long long>(work.node_visits), static_cast<unsigned long long>(work.box_tests),
        static_cast<unsigned long long>(work.primitive_tests));
    told += text;
    response.rays = stats.counts.rays.total();
    results.rays = response.rays;
  } else {
    told += "kept;desc=\"cached from another request\"";
  }
  set_results(response, results);
  response.set("Server-Timing", std::move(told));
  return response;
}

void set_content_location(Response& response, std::string_view type, const Scene& scene,
                          const Picture& picture, const std::string& prefix) {
  if (!picture.budget || type != "image/png") return;
  response.set("Content-Location", frame_path(prefix, scene.id, query_of(scene, picture.budget->settings)));
}

Response json_answer(int status, const nlohmann::ordered_json& json) {
  return json_response(status, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace orrery
