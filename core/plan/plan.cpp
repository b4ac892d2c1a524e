#include "core/plan/plan.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <optional>

#include "core/accelerators/registry.h"
#include "core/cameras/pixel_filter.h"
#include "core/channels/registry.h"
#include "core/image/srgb.h"
#include "core/plan/options.h"
#include "core/plan/rounding.h"
#include "core/plan/warnings.h"
#include "core/techniques/registry.h"

namespace orrery {
namespace {

// Returns the type with this name. REQUIRES: the name was validated when it was read.
template <class Types>
auto find_type(const Types& types, const std::string& name) {
  const auto found = std::find_if(types.begin(), types.end(), [&](const auto& t) { return name == t.name; });
  assert(found != types.end());
  return &*found;
}

constexpr int kFewPrimitives = 8, kMaxTries = 1024;

class Planner {
 public:
  Planner(const Scene& scene, const RenderRequest& request) : scene_(scene), request_(request) {}

  Plan make() {
    take_request();
    if (scene_.facts.left_out > 0)
      decide("triangles without area", std::to_string(scene_.facts.left_out) + " left out",
             "no ray can meet them");
    if (!scene_.motion.empty()) {
      const auto& [first, last] = scene_.motion;
      decide("time", seconds(plan_.time), "the motion runs from " + seconds(first) + " to " + seconds(last));
    }
    open_shutter();
    choose_filter();
    choose_precision();
    choose_accelerator();
    choose_order();
    choose_prediction();
    const SceneFacts& facts = scene_.facts;
    if (plan_.technique->draws_light) {
      plan_.cut_range = plan_.technique->interreflects
                            ? facts.path_radiance.max_deviation(Vec3d(0))
                            : largest(facts.distributed_radiance.max_deviation(Vec3d(0)), scene_.ambient);
      choose_paths();
    } else {
      plan_.cut_range = facts.tree_radiance.max_deviation(scene_.ambient);
      const bool negative = plan_.filtered && has_negative_lobes(*plan_.asked.filter);
      if (!negative)  // rays that are cut return ambient light
        plan_.sample_range = max_component(largest(facts.tree_radiance.most, scene_.ambient));
      leave_out_for_trees();
    }
    if (request_.full_model || plan_.technique->draws_light) return plan_;
    choose_lights();
    choose_specular();
    plan_.free_contribution = plan_.free_contribution && plan_.max_depth > 0;
    return plan_;
  }

 private:
  static std::string seconds(double time) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g s", time);
    return text;
  }
  void decide(std::string subject, std::string choice, std::string reason, const Bound& bound = {}) {
    plan_.decisions.push_back({std::move(subject), std::move(choice), std::move(reason), bound});
  }

  // Returns whether a budget chooses the value of an option that the request may set.
  template <class T>
  bool is_free(const std::optional<T>& named) const {
    return !named && has_budget(plan_.asked);
  }

  void take_request() {
    plan_.asked = resolve(scene_, request_);
    const RenderSettings& asked = plan_.asked;
    plan_.width = *asked.width;
    plan_.height = *asked.height;
    plan_.samples = *asked.samples;
    plan_.max_depth = *asked.max_depth;
    plan_.min_contribution = *asked.min_contribution;
    plan_.seed = *asked.seed;
    plan_.view = *asked.view;
    plan_.slice = request_.slice / 16 * 16;
    if (*asked.space == Space::display) plan_.space = Space::display;
    plan_.technique = find_type(technique_types(), *asked.technique);
    plan_.time = *asked.time;
    plan_.not_followed = plan_.technique->not_followed;
    if (loses_caustics(scene_, plan_)) plan_.not_followed.push_back("caustics of lights without extent");
    take_budget();
    take_camera();
  }

  void take_budget() {
    const RenderSettings& asked = plan_.asked;
    if (!has_budget(asked)) return;
    require_picture(asked, "a budget");
    plan_.free_samples = !request_.samples;
    plan_.free_contribution = *asked.error > 0 && !request_.min_contribution && !plan_.technique->draws_light;
    if (*asked.error > 0)
      decide("error", "at most " + number_text(*asked.error) + " RMS",
             "as asked, of " + std::string(name_of(plan_.space)) +
                 " values; samples are traced until they tell that it is so");
    if (*asked.seconds > 0) decide("seconds", "at most " + seconds(*asked.seconds), "as asked");
    if (plan_.free_samples)
      decide("samples", "at most " + std::to_string(plan_.samples), "a budget chooses them");
  }

  void open_shutter() {
    const double asked = *plan_.asked.shutter;
    if (asked == 0) return;
    if (!scene_.motion.within({plan_.time, plan_.time + asked}))
      return decide("shutter", "absent", "nothing moves while it is open");
    plan_.shutter = asked;
    const bool all_at_once = plan_.samples == 1 && !plan_.technique->draws_light;
    decide("shutter", "open for " + seconds(asked),
           all_at_once ? "the only sample is taken in the middle of it; more are spread over it"
                       : "each sample is taken at a time of its own");
  }

  void choose_filter() {
    const Filter filter = *plan_.asked.filter;
    if (!warps_samples(filter, *plan_.asked.filter_width)) return;
    plan_.filtered = plan_.samples > 1 || plan_.technique->draws_light;
    if (plan_.filtered)
      decide("filter", std::string(name_of(filter)),
             has_negative_lobes(filter) ? "as asked; what it takes away has samples of its own" : "as asked");
    else
      decide("filter", "absent", "the only sample is taken in the pixel's middle");
  }

  void take_camera() {
    plan_.fields |= scene_.facts.materials.fields;
    plan_.camera = scene_.camera;
    if (auto turned = scene_.camera->with_fov(*plan_.asked.fov_degrees))
      plan_.camera = std::move(turned);
    else if (request_.fov_degrees)
      decide("angle of view", "not as asked", "the camera of the scene has none");
    plan_.frame = frame_at(scene_.placement, *plan_.camera, orbit_of(plan_.asked));
    for (const std::string& name : *plan_.asked.layers) {
      plan_.channels.push_back(find_type(channel_types(), name));
      plan_.fields |= plan_.channels.back()->fields;
    }
  }

  // Chooses float if it is precise enough for all known rounding limits, else double.
  void choose_precision() {
    const Precision asked = *plan_.asked.precision;
    if (asked != Precision::automatic) {
      plan_.double_precision = asked == Precision::double_precision;
      return decide("precision", precision_name(plan_.double_precision),
                    is_free(request_.precision)
                        ? "what float does to a picture is not bounded, and budgets promise errors"
                        : "as asked",
                    rounding_bound());
    }
    if (plan_.technique->draws_light && plan_.frame.aperture_radius > plan_.frame.focus_distance) {
      plan_.double_precision = true;
      return decide("precision", "double", "rays leave the lens far from where they are sharp",
                    rounding_bound());
    }
    const RoundingLimit limit = rounding_limit(scene_, plan_);
    plan_.double_precision = !(double{std::numeric_limits<float>::epsilon()} <= limit.epsilon);
    decide("precision", precision_name(plan_.double_precision),
           plan_.double_precision ? limit.reason : "rounding to float is small beside all that is to be seen",
           rounding_bound());
  }

  // Returns the error of rounding. Float has no proven bound yet. Double is the reference and counts as
  // exact.
  Bound rounding_bound() const { return plan_.double_precision ? Bound() : Bound::unknown(); }

  void choose_accelerator() {
    const std::string& asked = *plan_.asked.accelerator;
    if (asked != "auto") {
      plan_.accelerator = find_type(accelerator_types(), asked);
      return decide("accelerator", asked, "as asked");
    }
    const int count = scene_.primitive_count();
    const bool few = count <= kFewPrimitives;
    plan_.try_accelerators = !few && count <= kMaxTries && !plan_.technique->draws_light;
    plan_.accelerator = find_type(accelerator_types(), few ? "list" : "bvh");
    decide("accelerator", plan_.accelerator->name,
           few ? "so few primitives that testing each costs less than any structure"
               : "of all structures it took the least time on every scene measured with more than " +
                     std::to_string(kMaxTries) + " primitives, and on paths");
  }

  void choose_order() {
    plan_.reorder = *plan_.asked.reorder;
    if (plan_.reorder) decide("order of rays", "sorted by origin and direction", "as asked");
  }

  void choose_prediction() {
    plan_.prediction = *plan_.asked.prediction;
    if (plan_.prediction != Prediction::none)
      decide("prediction of shadows", std::string(name_of(plan_.prediction)),
             "as asked; what it proposes is tested, so the picture stays the same");
  }

  void choose_lights() {
    const bool glows = any_light_shines(scene_);
    plan_.direct_light = glows && scene_.facts.materials.lit;
    if (!plan_.direct_light) {
      plan_.shadows = false;
      return decide("direct light", "absent",
                    glows ? "no material in use answers light sources" : "no light source");
    }
    const bool parallel_light =
        any_light([](const LightSet& lights, int) { return lights.traits().parallel; });
    plan_.constant_half = parallel_light && plan_.camera->parallel();
    if (plan_.constant_half)
      decide("half vector", "computed once",
             "the viewer and a light are parallel, so it is the same everywhere");
    plan_.shadows = !lonely_convex() || scene_.facts.materials.transmits;
    decide("shadows", plan_.shadows ? "traced" : "absent",
           plan_.shadows ? "objects may stand between light and surface"
                         : "the only object is convex and seen from outside: nothing stands in its light");
  }

  // Reports scene features that only path techniques render.
  void leave_out_for_trees() {
    const std::string only =
        std::string(plan_.technique->name) + " does not follow such light; distributed and path do";
    if (plan_.frame.aperture_radius > 0) decide("lens", "absent", only, Bound::unknown());
    if (scene_.facts.materials.emits)
      decide("light of surfaces that emit", "seen, lights nothing", only, Bound::unknown());
    if (scene_.environment)
      decide("light of the environment", "seen, lights nothing", only, Bound::unknown());
    if (any_light([](const LightSet& lights, int index) { return lights.extended(index); }))
      decide("extent of lights", "absent: one point or direction each", only, Bound::unknown());
  }

  void choose_paths() {
    plan_.lens = plan_.frame.aperture_radius > 0;
    if (plan_.lens)
      decide("lens", "thin",
             "its aperture has a radius of " + number_text(plan_.frame.aperture_radius) + " m");
    plan_.min_contribution = 0;
    plan_.clamp_indirect = *plan_.asked.clamp_indirect;
    if (plan_.clamp_indirect > 0)
      decide("clamp of indirect light", "at " + number_text(plan_.clamp_indirect),
             "as asked; the picture tells what it took away", Bound::unknown());
    if (plan_.technique->interreflects) {
      if (scene_.ambient != Vec3d(0)) decide("ambient light", "absent", "surfaces light each other instead");
      choose_reuse();
    } else if (scene_.facts.materials.diffuse) {
      decide("light between diffuse surfaces",
             scene_.ambient == Vec3d(0) ? "absent" : "ambient light instead",
             std::string(plan_.technique->name) + " ends paths at diffuse surfaces; path follows them",
             Bound::unknown());
    }
    decide("depth", std::to_string(plan_.max_depth),
           depth_reason() + (plan_.technique->interreflects
                                 ? "; what longer paths would bring is left out"
                                 : "; ambient light stands for what longer paths would bring"),
           cut_bound(std::pow(max_component(scene_.facts.albedo), plan_.max_depth)));
  }

  std::string depth_reason() const {
    if (is_free(request_.max_depth)) return "the most there may be, for the budget asked";
    return request_.max_depth || scene_.render.max_depth ? "as asked" : "by default";
  }

  void choose_reuse() {
    const bool shares = plan_.max_depth >= 2 && scene_.facts.materials.lit && plan_.shutter == 0;
    plan_.reuse = shares ? static_cast<int>(std::bit_floor(static_cast<unsigned>(*plan_.asked.reuse)))
                         : 1;  // must divide a tile
    decide("reuse of paths", plan_.reuse > 1 ? "groups of " + std::to_string(plan_.reuse) : "none",
           plan_.reuse > 1     ? "connections to what others found cost less than paths of one's own"
           : shares            ? "as asked"
           : plan_.shutter > 0 ? "paths of different times meet different scenes"
                               : "no path has a second vertex that receives light");
  }

  void choose_specular() {
    const MaterialTraits& used = scene_.facts.materials;
    plan_.specular = used.mirrors;
    plan_.filters = plan_.specular && used.filters;
    if (!plan_.specular) {
      plan_.max_depth = 0;
      return decide("mirrored and refracted rays", "absent", "no smooth material in use mirrors or refracts");
    }
    if (!plan_.technique->secondary_rays) {
      plan_.max_depth = 0;
      return decide("mirrored and refracted rays", "absent",
                    std::string(plan_.technique->name) + " sends none", Bound::unknown());
    }
    if (!used.transmits) decide("refracted rays", "absent", "no material in use is transparent");
    if (!plan_.filters) decide("filtering in bodies", "absent", "no body in use weakens light");
    if (!used.transmits && lonely_convex() && plan_.max_depth > 1) {
      plan_.max_depth = 1;
      decide("depth", "1", "the only object is convex: its mirrored rays meet nothing");
    } else {
      decide("depth", std::to_string(plan_.max_depth),
             depth_reason() + "; deeper rays are replaced by ambient light", cut_bound(1));
    }
    if (plan_.min_contribution > 0)
      decide("least contribution",
             (plan_.free_contribution ? "at most " : "") + number_text(plan_.min_contribution),
             contribution_reason() + "; weaker rays are replaced by ambient light", cut_bound(1));
  }

  std::string contribution_reason() const {
    if (plan_.free_contribution) return "the error asked chooses it";
    return is_free(request_.min_contribution) ? "a quarter of what a code of 8 bits stands for" : "as asked";
  }

  // Returns an a-priori bound of rays that are not traced, of this total weight. The bound measured while
  // rendering is tighter.
  Bound cut_bound(double weight) const {
    const double radiance = weight * max_component(plan_.cut_range);
    const double most = plan_.space == Space::display ? encode_srgb(radiance) : radiance;
    return Bound::proved(most, most);
  }

  // Returns whether `has(set, index)` is true for some light.
  template <class Has>
  bool any_light(const Has& has) const {
    return std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const LightPlace& light) {
      return has(*scene_.light_sets[light.set], light.index);
    });
  }

  // Returns whether the scene is one convex primitive with the eye certainly outside it.
  bool lonely_convex() const {
    if (scene_.primitive_count() != 1) return false;
    for (const auto& shapes : scene_.shapes) {
      if (shapes->size() == 0) continue;
      const ShapeTraits traits = shapes->traits();
      if (!traits.convex) return false;
      const bool outside = !plan_.camera->parallel() && !shapes->bounds(0).contains(plan_.frame.eye);
      return !traits.closed || outside;
    }
    return false;
  }

  const Scene& scene_;
  const RenderRequest& request_;
  Plan plan_;
};

}  // namespace

bool any_light_shines(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const LightPlace& light) {
    return scene.light_sets[light.set]->intensity(light.index) != Vec3d(0);
  });
}

Plan make_plan(const Scene& scene, const RenderRequest& request) { return Planner(scene, request).make(); }

RenderSettings settings_of(const Plan& plan) {
  RenderSettings settings = plan.asked;
  settings.accelerator = plan.accelerator->name;
  settings.precision = plan.double_precision ? Precision::double_precision : Precision::single_precision;
  // The plan may have reduced the depth for this view only.
  settings.max_depth = plan.max_depth == 0 ? 0 : *plan.asked.max_depth;
  settings.min_contribution = plan.min_contribution;
  return settings;
}

}  // namespace orrery
