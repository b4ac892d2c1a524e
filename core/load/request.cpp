#include "core/load/load.h"
#include "core/load/names_of.h"
#include "core/params/motion.h"
#include "core/plan/limits.h"

namespace orrery {
namespace {

// Optional keys without a default: what is not there stays as the scene says.
template <class V, class Read>
void take(Params& p, const char* key, std::optional<V>& into, const Read& read) {
  const V value = static_cast<V>(read());
  if (p.has(key)) into = value;
}

void read_camera(Params& p, RenderRequest& request) {
  Orbit& orbit = request.orbit;
  orbit.azimuth_degrees = p.number("azimuth_degrees", "Turn about up through look_at.",
                                   {.min = -kMaxOrbitDegrees, .max = kMaxOrbitDegrees}, 0.0);
  orbit.elevation_degrees = p.number("elevation_degrees", "Lift toward up.", {.min = -180, .max = 180}, 0.0);
  orbit.distance = p.number("distance", "Factor of the own distance from look_at.",
                            {.min = kMinOrbitDistance, .max = kMaxOrbitDistance}, 1.0);
  orbit.pan = p.point("pan", "Metres by which eye and look_at are moved.", Vec3d{0, 0, 0});
  take(p, "fov_degrees", request.fov_degrees, [&] {
    return p.number("fov_degrees", "Vertical angle of the picture.",
                    {.min = 0, .max = 180, .exclusive_min = true, .exclusive_max = true}, derived(45.0));
  });
}

void read_image(Params& p, RenderRequest& request) {
  take(p, "width", request.width,
       [&] { return p.integer("width", "Pixels.", 1, kMaxImageSide, derived<std::int64_t>(600)); });
  take(p, "height", request.height,
       [&] { return p.integer("height", "Pixels.", 1, kMaxImageSide, derived<std::int64_t>(600)); });
}

void read_render(Params& p, RenderRequest& request) {
  const std::vector<std::string_view> techniques = technique_names(), accelerators = accelerator_names();
  take(p, "technique", request.technique,
       [&] { return p.choice("technique", "How light is followed.", techniques, "whitted"); });
  take(p, "max_depth", request.max_depth, [&] {
    return p.integer("max_depth", "Deepest ray that is traced.", 0, kMaxDepth, derived<std::int64_t>(5));
  });
  take(p, "min_contribution", request.min_contribution, [&] {
    return p.number("min_contribution", "Rays with less weight are not traced.", {.min = 0, .max = 1},
                    derived(0.0));
  });
  take(p, "samples", request.samples,
       [&] { return p.integer("samples", "Rays a pixel.", 1, kMaxSamples, derived<std::int64_t>(1)); });
  take(p, "accelerator", request.accelerator,
       [&] { return p.choice("accelerator", "How rays find what they meet.", accelerators, "auto"); });
  take(p, "precision", request.precision, [&] {
    return precision_of(p.choice("precision", "Number type of rays.", {"auto", "float", "double"}, "auto"));
  });
  take(p, "seed", request.seed, [&] {
    return p.integer("seed", "Seed of all random choices.", 0, kMaxSeed, derived<std::int64_t>(0));
  });
  take(p, "reorder", request.reorder,
       [&] { return p.flag("reorder", "Rays that are alike are traced together.", derived(false)); });
  take(p, "prediction", request.prediction, [&] {
    return prediction_of(
        p.choice("prediction", "Who proposes what may shadow a point.", kPredictions, "none"));
  });
  take(p, "time", request.time, [&] {
    return p.number("time", "Moment of what moves, in seconds.", {.min = -kMaxTime, .max = kMaxTime},
                    derived(0.0));
  });
}

}  // namespace

RenderRequest read_request(const Document& document, const std::function<void(Params&)>& more) {
  RenderRequest request;
  read_document(document, [&](Params& p) {
    p.any("scene", "The scene itself.");
    p.any("scene_id", "Or the id of one sent before.");
    p.optional_object("camera", "Where on its orbit the camera stands.",
                      [&](Params& c) { read_camera(c, request); });
    p.optional_object("image", "Size of the picture.", [&](Params& i) { read_image(i, request); });
    p.optional_object("render", "How the picture is made.", [&](Params& r) { read_render(r, request); });
    if (more) more(p);
  });
  return request;
}

}  // namespace orrery
