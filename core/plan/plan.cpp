#include "core/plan/plan.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <optional>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "core/cameras/pixel_filter.h"
#include "core/channels/registry.h"
#include "core/image/srgb.h"
#include "core/plan/explain_materials.h"
#include "core/plan/eye_media.h"
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

// Maximum numbers of primitives for which the plan uses `list`, and for which settle() tries other
// structures.
constexpr int kFewPrimitives = 8, kMaxTries = 1024;

class Planner {
 public:
  Planner(const Scene& scene, const RenderRequest& request) : scene_(scene), request_(request) {}

  Plan make() {
    take_request();
    if (scene_.facts.left_out > 0)
      decide("triangles without area", std::to_string(scene_.facts.left_out) + " dropped",
             "no ray can hit them");
    if (!scene_.motion.empty()) {
      const auto& [first, last] = scene_.motion;
      decide("time", seconds(plan_.time), "the motion runs from " + seconds(first) + " to " + seconds(last));
    }
    explain_materials(scene_, plan_);
    choose_terminator();
    open_shutter();
    choose_filter();
    choose_precision();
    choose_accelerator();
    choose_order();
    choose_prediction();
    choose_media();
    const SceneFacts& facts = scene_.facts;
    if (plan_.technique->draws_light) {
      plan_.cut_range = plan_.technique->interreflects
                            ? facts.path_radiance.max_deviation(Vec3d(0))
                            : largest(facts.distributed_radiance.max_deviation(Vec3d(0)), scene_.ambient);
      choose_paths();
    } else {
      plan_.cut_range = facts.tree_radiance.max_deviation(scene_.ambient);
      plan_.cut_range_beyond = facts.sky_radiance.max_deviation(scene_.ambient);
      plan_.occupied = facts.occupied;
      const bool negative = plan_.filtered && has_negative_lobes(*plan_.asked.filter);
      if (!negative)  // otherwise infinite; ambient light replaces untraced rays
        plan_.sample_range = max_component(largest(facts.tree_radiance.most, scene_.ambient));
      leave_out_for_trees();
    }
    if (plan_.technique->rasterizes) explain_rasterization();
    keep_energy_account();
    if (scene_.atmosphere)
      decide("atmosphere", scene_.atmosphere->type(),
             scene_.atmosphere->hides_background()
                 ? "attenuates light along every ray outside objects; its colour replaces the background"
                 : "fades objects with their depth; the background keeps its radiance");
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

  // Returns whether a budget chooses the value of an option. `named` is the option's value in the request.
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
    const bool unlimited = plan_.space == Space::linear && plan_.technique->draws_light;
    if (*asked.error > 0)
      decide("error", "at most " + number_text(*asked.error) + " RMS",
             "as specified, in " + std::string(name_of(plan_.space)) +
                 " values; samples are added until the certificate meets this limit" +
                 (unlimited ? ", with an estimated bound, because radiance is unbounded" : ""));
    if (*asked.seconds > 0) decide("seconds", "at most " + seconds(*asked.seconds), "as specified");
    if (plan_.free_samples)
      decide("samples", "at most " + std::to_string(plan_.samples), "chosen by the budget");
  }

  // Smooth meshes need the normals of their vertices if light sources light an opaque material.
  void choose_terminator() {
    const SceneFacts& facts = scene_.facts;
    const bool lit = any_light_shines(scene_) || (plan_.technique->draws_light && facts.materials.emits) ||
                     (plan_.technique->draws_light && scene_.environment && scene_.environment->sampled());
    if (!facts.smooth || !facts.materials.lit || !lit || plan_.technique->rasterizes) return;
    plan_.fields.smooth = true;
    decide("shadow terminator", "smooth",
           "shadow rays below the plane of a smooth triangle start at its curved surface (Hanika 2021)");
  }

  void open_shutter() {
    const double asked = *plan_.asked.shutter;
    if (asked == 0) return;
    if (!scene_.motion.within({plan_.time, plan_.time + asked}))
      return decide("shutter", "none", "nothing moves during the exposure");
    if (plan_.technique->rasterizes)
      return decide("shutter", "none", std::string(plan_.technique->name) + " shows the moment it opens",
                    Bound::unknown());
    plan_.shutter = asked;
    const bool all_at_once = plan_.samples == 1 && !plan_.technique->draws_light;
    decide("shutter", "open for " + seconds(asked),
           all_at_once ? "the only sample is taken at mid-exposure; more samples would be spread over it"
                       : "each sample has its own time");
  }

  void choose_filter() {
    const Filter filter = *plan_.asked.filter;
    if (!warps_samples(filter, *plan_.asked.filter_width)) return;
    plan_.filtered = plan_.samples > 1 || plan_.technique->draws_light;
    if (plan_.filtered)
      decide(
          "filter", std::string(name_of(filter)),
          has_negative_lobes(filter) ? "as specified; negative lobes have separate samples" : "as specified");
    else
      decide("filter", "none", "the only sample is at the pixel centre");
  }

  void take_camera() {
    plan_.fields |= scene_.facts.materials.fields;
    plan_.camera = scene_.camera;
    if (plan_.technique->rasterizes && plan_.camera->all_around())
      throw InputError("/render/technique", std::string(plan_.technique->name) +
                                                " does not support the camera type " + plan_.camera->type() +
                                                " (it supports perspective and orthographic)");
    if (auto turned = scene_.camera->with_fov(*plan_.asked.fov_degrees))
      plan_.camera = std::move(turned);
    else if (request_.fov_degrees)
      decide("field of view", "ignored", "the camera type has no field of view");
    plan_.frame = frame_at(scene_.placement, *plan_.camera, orbit_of(plan_.asked));
    for (const std::string& name : *plan_.asked.layers) {
      plan_.channels.push_back(find_type(channel_types(), name));
      plan_.fields |= plan_.channels.back()->fields;
    }
  }

  // Uses the requested precision. For `auto`, chooses double if the technique models a lens whose aperture
  // radius exceeds the focus distance, or if the epsilon of float exceeds rounding_limit(). Else chooses
  // float.
  void choose_precision() {
    const Precision asked = *plan_.asked.precision;
    if (asked != Precision::automatic) {
      plan_.double_precision = asked == Precision::double_precision;
      return decide("precision", precision_name(plan_.double_precision),
                    is_free(request_.precision)
                        ? "single-precision rounding error has no proven bound, and a budget needs one"
                        : "as specified",
                    rounding_bound());
    }
    if (plan_.technique->draws_light && plan_.frame.aperture_radius > plan_.frame.focus_distance) {
      plan_.double_precision = true;
      return decide("precision", "double", "the aperture radius exceeds the focus distance",
                    rounding_bound());
    }
    const RoundingLimit limit = rounding_limit(scene_, plan_);
    plan_.double_precision = !(double{std::numeric_limits<float>::epsilon()} <= limit.epsilon);
    decide(
        "precision", precision_name(plan_.double_precision),
        plan_.double_precision ? limit.reason : "float rounding is small compared with all visible details",
        rounding_bound());
  }

  // Returns the bound of the rounding error. It is unknown for float, which has no proven bound, and exact
  // for double, which is the reference.
  Bound rounding_bound() const { return plan_.double_precision ? Bound() : Bound::unknown(); }

  void choose_accelerator() {
    const std::string& asked = *plan_.asked.accelerator;
    if (plan_.technique->rasterizes) {
      plan_.accelerator = find_type(accelerator_types(), "list");
      return decide("accelerator", "none", "a z-buffer finds the visible triangles");
    }
    if (asked != "auto") {
      plan_.accelerator = find_type(accelerator_types(), asked);
      return decide("accelerator", asked, "as specified");
    }
    const int count = scene_.primitive_count();
    const bool few = count <= kFewPrimitives;
    plan_.try_accelerators = !few && count <= kMaxTries && !plan_.technique->draws_light;
    plan_.accelerator = find_type(accelerator_types(), few ? "list" : "bvh");
    decide("accelerator", plan_.accelerator->name,
           few ? "with at most " + std::to_string(kFewPrimitives) +
                     " primitives, testing all of them is cheaper than any structure"
               : "the fastest structure on every measured scene with more than " + std::to_string(kMaxTries) +
                     " primitives, and for paths");
  }

  void choose_order() {
    plan_.reorder = *plan_.asked.reorder;
    if (plan_.reorder) decide("ray order", "sorted by origin and direction", "as specified");
  }

  void choose_prediction() {
    plan_.prediction = *plan_.asked.prediction;
    if (plan_.prediction != Prediction::none && scene_.facts.cutouts) {
      plan_.prediction = Prediction::none;
      decide("shadow prediction", "none", "predicted surfaces may let rays pass");
    }
    if (plan_.prediction != Prediction::none)
      decide("shadow prediction", std::string(name_of(plan_.prediction)),
             "as specified; every prediction is verified, so the image does not change");
  }

  // Follows the media around rays only if a ray may be in two bodies at once, or an opaque surface inside a
  // body that absorbs light.
  void choose_media() {
    const Media& media = scene_.media;
    const MaterialTraits& used = scene_.facts.materials;
    if (!plan_.technique->secondary_rays || !used.transmits || plan_.max_depth == 0) return;
    if (!media.nested())
      return decide("nested media", "none", "bodies of transparent materials contain and touch no others");
    plan_.media = true;
    plan_.eye_in_media = may_start_in(media, plan_);
    plan_.eye_passes = plan_.eye_in_media || media.like_air();
    decide("nested media", plan_.eye_in_media ? "followed from the eye" : "followed",
           media.where.empty() ? media.scattering + " scatters light inside"
                               : media.where + " and " + media.other + " may be in one place");
    choose_scattering();
  }
  void choose_scattering() {
    const Media& media = scene_.media;
    if (!media.scatters()) return;
    plan_.scatters = plan_.technique->interreflects;
    if (plan_.scatters)
      return decide("scattering inside bodies", "random walk",
                    "at most " + std::to_string(kMaxScatterings) + " events between two surfaces",
                    Bound::unknown());
    decide("scattering inside bodies", "none",
           std::string(plan_.technique->name) + " only attenuates light there; path scatters it",
           Bound::unknown());
  }
  void choose_lights() {
    const bool glows = any_light_shines(scene_);
    plan_.direct_light = glows && scene_.facts.materials.lit;
    if (!plan_.direct_light) {
      plan_.shadows = false;
      return decide("direct light", "none", glows ? "no material in use is lit directly" : "no light source");
    }
    const bool parallel_light =
        any_light([](const LightSet& lights, int) { return lights.traits().parallel; });
    plan_.constant_half = parallel_light && plan_.camera->parallel();
    if (plan_.constant_half)
      decide("half vector", "computed once", "the directions to viewer and light are constant");
    if (plan_.technique->rasterizes) return;  // shadows: see explain_rasterization()
    plan_.shadows = !lonely_convex() || scene_.facts.materials.transmits || scene_.facts.cutouts;
    decide("shadows", plan_.shadows ? "traced" : "none",
           plan_.shadows ? "objects may block light"
                         : "the only object is convex and seen from outside: nothing blocks its light");
  }

  void keep_energy_account() {
    if (!*plan_.asked.energy) return;
    if (plan_.technique->rasterizes)
      return decide("energy account", "none",
                    std::string(plan_.technique->name) + " lights points, not rays");
    plan_.energy_of = scene_.material_names;
    decide("energy account", "kept", "as specified; the image does not change");
  }

  void explain_rasterization() {
    plan_.shadows = false;
    const bool in_image = *plan_.asked.interpolation == Interpolation::screen;
    decide("surfaces", "triangles",
           "curved surfaces are approximated to within " + number_text(*plan_.asked.tessellation_error) +
               " pixels",
           Bound::unknown());
    decide(
        "interpolation", in_image ? "linear in the image" : "linear in the scene",
        in_image ? "as specified; the incremental form, with perspective distortion" : "perspective-correct");
    decide("shadows", "none", std::string(plan_.technique->name) + " does not model them; raycast does",
           Bound::unknown());
  }

  // Adds a decision for each scene feature that only the techniques distributed and path model.
  void leave_out_for_trees() {
    const std::string only =
        std::string(plan_.technique->name) + " does not model it; distributed and path do";
    if (plan_.frame.aperture_radius > 0) decide("lens", "ignored", only, Bound::unknown());
    if (scene_.facts.materials.emits)
      decide("light of emissive surfaces", "visible, but illuminates no surface", only, Bound::unknown());
    if (scene_.environment)
      decide("light of the environment", "visible, but illuminates no surface", only, Bound::unknown());
    if (any_light([](const LightSet& lights, int index) { return lights.extended(index); }))
      decide("extent of lights", "ignored: each light has one point or direction", only, Bound::unknown());
  }

  void choose_paths() {
    plan_.lens = plan_.frame.aperture_radius > 0;
    if (plan_.lens)
      decide("lens", "thin", "aperture radius " + number_text(plan_.frame.aperture_radius) + " m");
    plan_.min_contribution = 0;
    plan_.clamp_indirect = *plan_.asked.clamp_indirect;
    if (plan_.clamp_indirect > 0)
      decide("indirect light clamp", "at " + number_text(plan_.clamp_indirect),
             "as specified; the image reports the removed light", Bound::unknown());
    if (plan_.technique->interreflects) {
      if (scene_.ambient != Vec3d(0))
        decide("ambient light", "ignored", "replaced by light that surfaces reflect");
      choose_reuse();
    } else if (scene_.facts.materials.diffuse) {
      decide("diffuse interreflection", scene_.ambient == Vec3d(0) ? "none" : "ambient light instead",
             std::string(plan_.technique->name) + " ends paths at diffuse surfaces; path continues them",
             Bound::unknown());
    }
    decide("depth", std::to_string(plan_.max_depth),
           depth_reason() + (plan_.technique->interreflects ? "; light of longer paths is omitted"
                                                            : "; ambient light replaces longer paths"),
           cut_bound(std::pow(max_component(scene_.facts.albedo), plan_.max_depth)));
  }

  std::string depth_reason() const {
    if (is_free(request_.max_depth)) return "the maximum, because of the budget";
    return request_.max_depth || scene_.render.max_depth ? "as specified" : "default";
  }

  void choose_reuse() {
    const bool shares = plan_.max_depth >= 2 && scene_.facts.materials.lit && plan_.shutter == 0 &&
                        !plan_.media && !scene_.atmosphere;
    plan_.reuse = shares ? static_cast<int>(std::bit_floor(static_cast<unsigned>(*plan_.asked.reuse)))
                         : 1;  // a power of two, because it must divide the pixels of a tile
    decide("path reuse", plan_.reuse > 1 ? "groups of " + std::to_string(plan_.reuse) : "none",
           plan_.reuse > 1     ? "connections to vertices of other paths cost less than new paths"
           : shares            ? "as specified"
           : plan_.media       ? "paths in different media see different surfaces"
           : plan_.shutter > 0 ? "paths at different times see different geometry"
           : scene_.atmosphere ? "the atmosphere attenuates each connection differently"
                               : "no path has a second vertex that receives light");
  }

  void choose_specular() {
    const MaterialTraits& used = scene_.facts.materials;
    plan_.specular = used.mirrors;
    plan_.filters = plan_.specular && used.filters;
    if (!plan_.specular) {
      plan_.max_depth = 0;
      return decide("reflected and refracted rays", "none", "no smooth material in use reflects or refracts");
    }
    if (!plan_.technique->secondary_rays) {
      if (plan_.technique->rasterizes && used.straight)
        return decide("transparency", "without refraction",
                      "surfaces behind transparent ones are drawn in the order of their depth, up to depth " +
                          std::to_string(plan_.max_depth),
                      cut_bound(1));
      plan_.max_depth = 0;
      return decide("reflected and refracted rays", "none",
                    std::string(plan_.technique->name) + " does not trace them", Bound::unknown());
    }
    if (!used.transmits) decide("refracted rays", "none", "no material in use is transparent");
    if (!plan_.filters) decide("absorption inside objects", "none", "no material in use absorbs light");
    if (!used.transmits && lonely_convex() && plan_.max_depth > 1) {
      plan_.max_depth = 1;
      decide("depth", "1", "the only object is convex: its reflected rays hit nothing");
    } else {
      decide("depth", std::to_string(plan_.max_depth),
             depth_reason() + "; ambient light replaces deeper rays", cut_bound(1));
    }
    if (plan_.min_contribution > 0)
      decide("minimum contribution",
             (plan_.free_contribution ? "at most " : "") + number_text(plan_.min_contribution),
             contribution_reason() + "; ambient light replaces weaker rays", cut_bound(1));
  }

  std::string contribution_reason() const {
    if (plan_.free_contribution) return "chosen by the error budget";
    return is_free(request_.min_contribution) ? "default with a time limit: a quarter of an 8-bit code"
                                              : "as specified";
  }

  // Returns an a-priori bound on the light of untraced rays with this total weight. The certificate of the
  // rendered image has a tighter bound.
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

  // Returns whether the scene is a single convex primitive that cannot contain the eye: an open primitive, or
  // a closed one whose bounds exclude the eye. The rays of a parallel camera may start inside a closed
  // primitive.
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
  // The plan may have reduced the depth to 1 because of the eye. The settings keep the requested depth.
  settings.max_depth = plan.max_depth == 0 ? 0 : *plan.asked.max_depth;
  settings.min_contribution = plan.min_contribution;
  return settings;
}

}  // namespace orrery
