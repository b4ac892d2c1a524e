#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "core/plan/plan.h"
#include "core/plan/warnings.h"
#include "server/app/app.h"
#include "server/rendering/picture_key.h"
#include "server/routes/answers.h"
#include "server/routes/picture_stream.h"
#include "server/scheduler/handler_slots.h"

// GET /v1/scenes/{id}/orbit: streams the frames of a camera orbit as they are rendered.
namespace orrery {
namespace {

constexpr std::array<std::string_view, 4> kOwnParameters{"frames", "step", "time_step", "fps"};

// Returns the value of a query parameter, or `fallback` if it is missing or invalid. Appends a problem if it
// is invalid.
double number_of(const Request& request, std::string_view name, double min, double max, double fallback,
                 std::vector<Problem>& problems) {
  for (const auto& [key, text] : request.query) {
    if (key != name) continue;
    const auto number = parse_number<double>(text);
    if (number && *number >= min && *number <= max) return *number;
    char range[96];
    std::snprintf(range, sizeof range, "must be a number from %g to %g (got ", min, max);
    problems.push_back({"/" + key, range + quoted(text) + ")"});
  }
  return fallback;
}

OrbitSpec read_orbit(App& app, const Request& request) {
  OrbitSpec spec;
  spec.scene = app.scenes().find(request.path_value("id"));
  const Scene& scene = spec.scene->scene();
  const RenderRequest first = read_query(request, kOwnParameters);
  require_layers_kept(first, FileFormat::png);
  require_no_budget(first, "an orbit stream");
  std::vector<Problem> problems;
  const double frames = number_of(request, "frames", 1, app.settings().orbit_frames, 120, problems);
  if (frames != std::floor(frames))
    problems.push_back({"/frames", "must be an integer (got " + number_text(frames) + ")"});
  spec.frames = static_cast<int>(frames);
  spec.path = full_turn(scene, first, spec.frames);
  spec.path.step_degrees = number_of(request, "step", -360, 360, spec.path.step_degrees, problems);
  spec.path.step_seconds =
      number_of(request, "time_step", -kLongestStep_s, kLongestStep_s, spec.path.step_seconds, problems);
  spec.fps = number_of(request, "fps", 0, 240, 30, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  require_range(spec.path, spec.frames, "/step");
  spec.client = request.client;
  spec.key = canonical_orbit(scene, spec.path, spec.frames) + " " + number_text(spec.fps + 0.0);
  return spec;
}

ImageResults results_of(const Frame& frame) {
  return {.stats = &frame.stats, .certificate = &frame.certificate, .rays = frame.stats.counts.rays.total()};
}

nlohmann::ordered_json header_of(const OrbitFrame& frame, std::int64_t skipped) {
  const Frame& picture = frame.picture;
  nlohmann::ordered_json header = {{"frame", frame.frame},
                                   {"azimuth_degrees", frame.orbit.azimuth_degrees},
                                   {"elevation_degrees", frame.orbit.elevation_degrees},
                                   {"distance", frame.orbit.distance},
                                   {"time", frame.time},
                                   {"width", frame.width},
                                   {"height", frame.height},
                                   {"render_ms", picture.stats.build_ms + picture.stats.trace_ms},
                                   {"encode_ms", picture.encode_ms},
                                   {"skipped", skipped}};
  header.update(result_members(&ResultOutputs::orbit_frame, results_of(picture)));
  return header;
}

SharedBytes picture_of(const std::shared_ptr<const OrbitFrame>& frame) {
  return {frame, frame->picture.bytes};
}

// State of an orbit stream whose first frame is rendered.
struct OrbitRequest {
  std::shared_ptr<const void> place;
  std::shared_ptr<OrbitBroadcast::Viewer> viewer;
  std::shared_ptr<const OrbitFrame> first;
  std::stop_token gone;
};

std::shared_ptr<const OrbitFrame> next_of(const OrbitRequest& orbit, WaitState::Kind kind) {
  const HandlerSlots::Wait wait(kind);
  return orbit.viewer->next(orbit.gone);
}

void send(const OrbitRequest& orbit, PictureWriter&& writer) {
  for (auto frame = orbit.first; frame; frame = next_of(orbit, WaitState::Kind::begun)) try {
      const auto header = header_of(*frame, orbit.viewer->skipped());
      const bool written =
          writer.write({.png = picture_of(frame),
                        .header = header,
                        .fields = result_headers(&ResultOutputs::orbit_part, results_of(frame->picture)),
                        .last = orbit.viewer->at_end()});
      if (!written) return;
    } catch (const LimitExceeded&) {  // skips the frame, like a slow viewer
    }
  writer.end();
}

Response orbit(App& app, Request& request) {
  app.require_open();
  const OrbitSpec spec = read_orbit(app, request);
  const StreamFormat format = negotiate_stream(request);
  Response response;
  set_stream_headers(response, format);
  const Scene& scene = spec.scene->scene();
  const Plan first = make_plan(scene, spec.path.at(0));
  set_results(response, {.warnings = find_warnings(scene, first)});
  if (request.method == "HEAD") return response;
  app.renders().require_request_rays(scene, first);
  OrbitRequest orbit{.place = app.streams().open(request.client),
                     .viewer = app.orbits().watch(spec),
                     .first = {},
                     .gone = request.gone};
  orbit.first = next_of(orbit, WaitState::Kind::turn);  // errors can still set the status
  if (!orbit.first && request.gone.stop_requested()) throw Cancelled("client disconnected");
  if (!orbit.first) throw Busy("service is shutting down", 5);
  response.stream = [orbit, format](Sink& sink) { send(orbit, PictureWriter(sink, format)); };
  return response;
}

}  // namespace

void add_orbit_routes(Router& router, App& app) {
  router
      .add("GET", "/v1/scenes/{id}/orbit", Scope::read, LogLevel::info,
           [&app](Request& request) { return orbit(app, request); })
      .describe(
          {.id = "watch_orbit",
           .summary = "Streams the frames of a camera orbit as they are rendered; slow viewers skip frames",
           .parameters = {kSceneId,
                          {"frames", "query", "Number of frames",
                           R"({"type": "integer", "minimum": 1, "default": 120})"},
                          {"fps", "query", "Maximum frames per second; 0: as fast as the client reads",
                           R"({"type": "number", "minimum": 0, "maximum": 240, "default": 30})"},
                          {"step", "query", "Degrees per frame; default: one full turn over all frames",
                           R"({"type": "number", "minimum": -360, "maximum": 360})"},
                          {"time_step", "query",
                           "Seconds of scene motion per frame; default: the whole motion over all frames",
                           R"({"type": "number", "minimum": -3600, "maximum": 3600})"}},
           .renders = true,
           .answers = {stream_answer(
               "A stream of PNG images, as multipart parts or as frames. A frame is a 4-byte big-endian "
               "length, a JSON header of that length, and a PNG of header.bytes bytes. ",
               "OrbitResults", &ResultOutputs::orbit_part)},
           .errors = {406}});
}

}  // namespace orrery
