#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/base/clock.h"
#include "core/base/number.h"
#include "core/load/scene_file.h"
#include "core/plan/plan.h"
#include "server/commands/checks.h"
#include "server/commands/commands.h"
#include "server/commands/frame_names.h"
#include "server/commands/help_layout.h"
#include "server/commands/output_file.h"
#include "server/commands/progress.h"
#include "server/commands/render_flags.h"
#include "server/commands/signals.h"
#include "server/commands/stats.h"
#include "server/rendering/orbit_budget.h"
#include "server/rendering/pipeline.h"
#include "server/scheduler/worker_pool.h"

namespace orrery {
namespace {

constexpr const char* kOrbitExamples = R"(
Examples:
  orrery orbit scenes/paper.json --frames 120 -o frame-%04d.png
  orrery orbit scenes/paper.json --frames 45 --step 2 -o turn-%d.jpg
  orrery orbit scenes/glass.json --error 0.02 -o frame-%04d.png
  orrery orbit scenes/paper.json --frames 240 --discard      # prints the speed

The camera turns once around the scene, or by --step per frame, while the motion
of the scene plays. A budget sets the samples of the first frame, and all frames
use them. FFmpeg makes a video for browsers (the filter makes the sides even):
  ffmpeg -framerate 30 -i frame-%04d.png -vf "pad=ceil(iw/2)*2:ceil(ih/2)*2" \
    -pix_fmt yuv420p orbit.mp4
)";

struct OrbitOptions {
  std::string output, stats;
  int frames = 120, threads = 0;
  double step = 0, time_step = 0;
  CLI::Option *step_given = nullptr, *time_step_given = nullptr;
  bool discard = false;
  RenderFlags render;
};

struct Totals {
  int frames = 0;
  std::uint64_t bytes = 0, rays = 0;
  int refitted = 0;  // frames with a refitted accelerator
  double worst = 1;  // maximum growth factor of their surface area
  double build_ms = 0;
  double render_ms = 0, encode_ms = 0;
  double seconds = 0, cpu_s = 0;

  void add(const Frame& frame) {
    ++frames;
    bytes += frame.bytes.size();
    rays += frame.stats.counts.rays.total();
    refitted += frame.stats.structure.refitted;
    worst = std::max(worst, frame.stats.structure.surface_area_growth);
    build_ms += frame.stats.build_ms;
    render_ms += frame.render_ms;
    encode_ms += frame.encode_ms;
  }
};

nlohmann::ordered_json json_of(const Totals& t, int threads) {
  return {{"frames", t.frames},
          {"seconds", t.seconds},
          {"frames_per_s", t.frames / t.seconds},
          {"cpu_s", t.cpu_s},
          {"build_ms", t.build_ms / t.frames},
          {"refitted", t.refitted},
          {"surface_area_growth", t.worst},
          {"render_ms", t.render_ms / t.frames},
          {"encode_ms", t.encode_ms / t.frames},
          {"bytes", t.bytes},
          {"rays", t.rays},
          {"threads", threads}};
}

void print(const Totals& t, int threads) {
  std::printf("%d frames in %.2f s, %.1f frames/s, threads %d\n", t.frames, t.seconds, t.frames / t.seconds,
              threads);
  std::printf("per frame: %.2f ms rendering, %.2f ms encoding, %.0f bytes, %.0f rays, %.2f ms CPU time\n",
              t.render_ms / t.frames, t.encode_ms / t.frames, double(t.bytes) / t.frames,
              double(t.rays) / t.frames, 1000 * t.cpu_s / t.frames);
  if (t.refitted > 0)
    std::printf(
        "per frame: %.2f ms building; structures: %d refitted, %d rebuilt; surface area of boxes at most "
        "%.2f times that at build time\n",
        t.build_ms / t.frames, t.refitted, t.frames - t.refitted, t.worst);
}

// Renders the frames of an orbit and writes them to files.
class OrbitRun {
 public:
  explicit OrbitRun(const OrbitOptions& options)
      : options_(options),
        names_(options.discard ? "frame-%d.png" : options.output),
        format_(format_of(names_.of(0))),
        first_(read_picture_flags(options.render, format_)),
        scene_(load_scene_file(options.render.scene)),
        path_(full_turn(scene_.scene(), first_, options.frames)),
        budget_(options.frames),
        pool_(options.threads) {
    if (options.step_given->count() > 0) path_.step_degrees = options.step;
    if (options.time_step_given->count() > 0) path_.step_seconds = options.time_step;
    require_range(path_, options.frames, "--step");
    if (!options.discard) require_writable(names_.of(0));
  }

  int threads() const { return pool_.threads(); }

  Totals run() {
    Totals totals;
    ProgressBar bar("frames");
    std::int64_t next = 0;
    const auto start = Clock::now();
    const double cpu_before = process_cpu_ms();
    const Pipeline pipeline{
        .pool = pool_,
        .background = false,
        .next = [&] { return next < options_.frames ? std::optional(next++) : std::nullopt; },
        .render = [&](std::int64_t n) { return render(n); },
        .encode = [&](const Film& film) { return encode_film(film, format_, kFrameOfStream); },
        .deliver =
            [&](std::int64_t n, Frame&& frame) {
              if (!options_.discard) write_file(names_.of(n), frame.bytes);
              totals.add(frame);
              bar.update(totals.frames, options_.frames);
            }};
    pipeline.run();
    totals.seconds = milliseconds_since(start) / 1000;
    totals.cpu_s = (process_cpu_ms() - cpu_before) / 1000;
    return totals;
  }

  // Returns null if there is no budget.
  nlohmann::ordered_json budget() const { return budget_.json(options_.frames); }

 private:
  RenderResult render(std::int64_t frame) {
    const std::stop_token stop = signals_.interrupted();
    const Plan plan = make_plan(scene_.scene(), path_.at(frame));
    RenderResult rendered = render_frame(scene_, settle(scene_, plan, stop), storage_for(format_, plan),
                                         executor_, {.stop = stop});
    budget_.add(scene_.scene(), rendered, path_);
    return rendered;
  }

  const OrbitOptions& options_;
  FrameNames names_;
  FileFormat format_;
  RenderRequest first_;
  PreparedScene scene_;
  OrbitPath path_;
  OrbitBudget budget_;
  SignalWatch signals_;  // created after the scene is read and before the pool starts its threads
  WorkerPool pool_;
  PoolExecutor executor_{pool_};
};

std::string budget_line(const nlohmann::ordered_json& budget, int frames) {
  const auto &largest = budget["largest_bound"], &met = budget["frames_met"];
  std::string text = met.is_null() ? "" : "met by " + met.dump() + " of ";
  text += std::to_string(frames) + " frames, with an error of " +
          (largest.is_null() ? "unknown size" : "up to " + rounded(largest.get<double>()));
  if (budget.contains("reason")) text += "; first frame: " + budget["reason"].get<std::string>();
  return text;
}

bool is_missed(const nlohmann::ordered_json& budget, int frames) {
  return !budget["met"] || (!budget["frames_met"].is_null() && budget["frames_met"] < frames);
}

int orbit(const OrbitOptions& options) {
  if (options.output.empty() && !options.discard)
    throw InputError("--output", "must be a name such as frame-%04d.png, unless --discard is given");
  OrbitRun turn(options);
  const Totals totals = turn.run();
  const nlohmann::ordered_json budget = turn.budget();
  if (!budget.is_null() && is_missed(budget, options.frames))
    std::cerr << "orrery: warning: budget missed: " << budget_line(budget, options.frames) << "\n";
  if (options.stats == "json") {
    nlohmann::ordered_json json = json_of(totals, turn.threads());
    if (!budget.is_null()) json["budget"] = budget;
    std::cout << json.dump() << "\n";
  } else if (options.discard || !options.stats.empty()) {
    print(totals, turn.threads());
    if (!budget.is_null())
      std::cout << "budget: " << budget_line(budget, options.frames)
                << "\nplan of the first frame: " << budget["plan"].get<std::string>() << "\n";
  }
  return kDone;
}

}  // namespace

Command add_orbit(CLI::App& root) {
  const auto options = std::make_shared<OrbitOptions>();
  CLI::App* app = root.add_subcommand("orbit", "Render the frames of an orbit around a scene");
  app->footer(kOrbitExamples);
  auto* output = app->add_option("-o,--output", options->output,
                                 "Image files: .png, .jpg or .exr; %d or %04d becomes the frame number")
                     ->type_name("NAME-%04d.png")
                     ->group(kCommonGroup);
  add_render_flags(*app, options->render);
  add_threads_flag(*app, options->threads);
  constexpr int kMaxFrames = 1'000'000;
  constexpr double kMaxStep = 360, kMaxTimeStep = 3600;
  app->add_option("--frames", options->frames,
                  with_range("Number of frames", 1, kMaxFrames, std::to_string(options->frames)))
      ->check(integer_from(1, kMaxFrames))
      ->type_name("N")
      ->group("Orbit");
  options->step_given =
      app->add_option("--step", options->step,
                      with_range("Degrees per frame", -kMaxStep, kMaxStep, "one full turn over all frames"))
          ->check(number_from(-kMaxStep, kMaxStep))
          ->type_name("DEGREES")
          ->group("Orbit");
  options->time_step_given = app->add_option("--time-step", options->time_step,
                                             with_range("Seconds of scene motion per frame", -kMaxTimeStep,
                                                        kMaxTimeStep, "the whole motion over all frames"))
                                 ->check(number_from(-kMaxTimeStep, kMaxTimeStep))
                                 ->type_name("SECONDS")
                                 ->group("Orbit");
  app->add_flag("--discard", options->discard, "Render and encode, print the speed, write no files")
      ->excludes(output)
      ->group("Output");
  app->add_flag("--stats{text}", options->stats, "Print times and sizes, as text or JSON")
      ->option_text("[=json]")
      ->group("Output");
  return {app, [options] { return orbit(*options); }};
}

}  // namespace orrery
