#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "core/params/params.h"
#include "server/api/results.h"
#include "server/rendering/orbit_budget.h"
#include "server/rendering/picture_key.h"
#include "server/routes/job_answers.h"
#include "server/routes/render_body.h"

// POST /v1/jobs: renders images and orbits that take too long for one HTTP request.
namespace orrery {
namespace {

using nlohmann::ordered_json;

// Renders one image or the frames of an orbit to PNG files.
class FrameWork final : public JobWork {
 public:
  FrameWork(const std::shared_ptr<const StoredScene>& scene, const OrbitPath& path, int frames)
      : scene_(scene),
        path_(path),
        budget_(frames),
        files_(static_cast<std::size_t>(frames)),
        results_(static_cast<std::size_t>(frames)) {}

  int steps() const override { return static_cast<int>(files_.size()); }
  RenderRequest request(int step) const override { return path_.at(step); }
  FileFormat format() const override { return FileFormat::png; }
  void add(const RenderResult& rendered) override {
    results_[added_++] = result_members(&ResultOutputs::job_step, results_of(rendered)).dump();
    if (const auto scene = scene_.lock()) budget_.add(scene->scene(), rendered, path_);
  }
  std::string encode(const Film& film) const override { return encode_film(film, format()); }
  void keep(int step, std::string&& encoded) override {
    encoded.shrink_to_fit();
    files_[static_cast<std::size_t>(step)] = std::move(encoded);
  }

  ordered_json links(const std::string& job_id) const override {
    return {{"first_frame", folder(job_id) + "0.png"}};
  }
  ordered_json links_of_step(const std::string& job_id, int step) const override {
    return {{"href", folder(job_id) + std::to_string(step) + ".png"}};
  }
  ordered_json status_fields(int steps_done) const override {
    ordered_json fields = ordered_json::object();
    if (steps_done == 0) return fields;
    if (ordered_json budget = budget_.json(steps_done); !budget.is_null())
      fields["budget"] = std::move(budget);
    return fields;
  }
  ordered_json step_fields(int step) const override {
    return ordered_json::parse(results_[static_cast<std::size_t>(step)]);
  }
  JobResult result(const std::string& job_id, std::string_view path) const override {
    const std::string begin = folder(job_id);
    if (path.starts_with(begin)) {
      const std::string_view name = path.substr(begin.size());
      const auto number = parse_number<int>(name.substr(0, name.find('.')));
      if (number && name == std::to_string(*number) + ".png" && *number >= 0 && *number < steps())
        return {
            "frame " + std::to_string(*number), "image/png", *number + 1,
            [this, step = *number](const std::string&) { return files_[static_cast<std::size_t>(step)]; }};
    }
    throw NotFound("unknown file; the files of the job are " + begin + "0.png to " +
                   std::to_string(steps() - 1) + ".png");
  }

 private:
  static std::string folder(const std::string& job_id) { return job_path(job_id) + "/frames/"; }

  const std::weak_ptr<const StoredScene> scene_;  // owned by the job while it renders
  OrbitPath path_;
  OrbitBudget budget_;
  std::vector<SharedBytes> files_;    // by step; empty until the step is done
  std::vector<std::string> results_;  // by step, as JSON text; empty until the step is added
  std::size_t added_ = 0;
};

struct FrameOrder {
  std::shared_ptr<const StoredScene> scene;
  OrbitPath path;
  int frames = 1;
};

FrameOrder read_frame_order(App& app, Request& request, RequestTrace& trace) {
  FrameOrder frames;
  double step_degrees = 0;
  std::optional<double> time_step_s;
  bool orbits = false;
  RenderBody body = read_render_body(app, request, trace, [&](Params& p) {
    orbits = p.has("orbit");
    p.optional_object("orbit", "Camera orbit; default: one image.", [&](Params& o) {
      const std::int64_t most = app.settings().orbit_frames;
      frames.frames = static_cast<int>(
          o.integer("frames", "Number of frames.", 1, most, std::min<std::int64_t>(most, orbits ? 120 : 1)));
      step_degrees = o.number("step_degrees", "Degrees per frame.", {.min = -360, .max = 360},
                              derived(360.0 / frames.frames));
      const double time = o.number("time_step_s", "Seconds of scene motion per frame.",
                                   {.min = -kLongestStep_s, .max = kLongestStep_s}, derived(0.0));
      if (o.has("time_step_s")) time_step_s = time;
    });
  });
  require_layers_kept(body.request, FileFormat::png);
  choose_space(body.request, FileFormat::png);
  frames.scene = body.scene;
  frames.path = full_turn(body.scene->scene(), body.request, frames.frames);
  frames.path.step_degrees = step_degrees;
  if (!orbits) frames.path.step_seconds = 0;
  if (time_step_s) frames.path.step_seconds = *time_step_s;
  require_range(frames.path, frames.frames, "/orbit/step_degrees");
  return frames;
}

Response start_frames(App& app, Request& request) {
  app.require_open();
  RequestTrace trace;
  const FrameOrder order = read_frame_order(app, request, trace);
  JobSpec spec{order.scene, std::make_unique<FrameWork>(order.scene, order.path, order.frames),
               request.client};
  return start_job(app, request, std::move(spec),
                   canonical_orbit(order.scene->scene(), order.path, order.frames), trace);
}

}  // namespace

void add_frame_jobs_routes(Router& router, App& app) {
  router
      .add("POST", "/v1/jobs", Scope::render, LogLevel::info, json_body(app),
           [&app](Request& request) { return start_frames(app, request); })
      .describe({.id = "start_job",
                 .summary = "Starts a long render: an image, or the frames of an orbit",
                 .parameters = {kIdempotencyKey},
                 .body = {"application/json", "JobRequest"},
                 .answers = {kJobAccepted},
                 .errors = {404}});
  router
      .add("GET", "/v1/jobs/{id}/frames/{frame}", Scope::read, LogLevel::info,
           [&app](Request& request) { return job_result(app, request, request.path_value("id")); })
      .describe({.id = "get_job_frame",
                 .summary = "Returns an image of a job",
                 .parameters = {kJobId, {"frame", "path", "0.png, 1.png, ..."}},
                 .etag = Operation::ETag::always,
                 .answers = {{200, "The image", {}, {{"image/png"}}}},
                 .errors = {409}});
}

}  // namespace orrery
