#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/math/affine.h"
#include "core/math/keyframes.h"
#include "core/model/atmosphere.h"
#include "core/model/camera.h"
#include "core/model/environment.h"
#include "core/model/light.h"
#include "core/model/material.h"
#include "core/model/media.h"
#include "core/model/occupied_space.h"
#include "core/model/radiance_range.h"
#include "core/model/render_settings.h"
#include "core/model/rounding.h"
#include "core/model/shape.h"
#include "core/model/texture.h"

// core/model contains the data types and interfaces that all stages of a render share. Scene is a scene as
// loaded, World the same scene in one number type, Plan the resolved settings, and Film the result. Const
// objects may be used by any number of threads. Functions throw only what their comments state, and
// std::bad_alloc.
namespace orrery {

// Extreme value in a scene (lengths in metres), and the JSON Pointer of the object with this value.
struct LocatedValue {
  double value;
  std::string where;
};

// Curved mirrors that reflect rays to each other. Position errors grow with each reflection.
struct MirrorChain {
  double growth = 1;  // error growth per reflection, weighted by the reflected light
  double radius = std::numeric_limits<double>::infinity();  // radius of curvature, metres
  std::string where;
};

// Assumed error of a hit / (machine epsilon times the largest coordinate).
inline constexpr double kRoundingsOfHit = 8;

// Turns of mirrored rays by the rounding errors of float.
struct MirrorTurns {
  static constexpr int kDepths = 32;
  // Root mean square over camera rays, in radians, of the largest turn after at most 1, 2, ... reflections. A
  // turn counts at most 1, times the reflected share of the light.
  std::array<double, kDepths> after{};
  double largest = 0;  // largest turn of one ray
  std::string where;   // object with the largest turn
};

// Properties of the scene that the plan uses, computed once.
struct SceneFacts {
  MaterialTraits materials;                                          // union over the materials in use
  std::size_t left_out = 0;                                          // primitives without area
  Boundsd bounds;                                                    // bounded primitives only
  bool unbounded = false;                                            // some primitive is unbounded
  bool smooth = false;                                               // some mesh has vertex normals
  bool cutouts = false;                                              // rays pass some surface: see Cutout
  RadianceRange tree_radiance, distributed_radiance, path_radiance;  // one per kind of technique
  RadianceRange sky_radiance;  // radiance of rays that miss everything, without lights at infinity
  OccupiedSpace occupied;
  Vec3d albedo;  // bound on the albedos of used materials
  // The members below, except max_albedo, are inputs to the choice of the number type.
  //
  // Largest absolute coordinate, including the anchors of unbounded primitives.
  LocatedValue magnitude{0, ""};
  // Smallest diagonal of the box of a bounded primitive, and smallest distance between two parallel surfaces,
  // of one body or of two. Infinite if the scene has none.
  LocatedValue smallest_feature{std::numeric_limits<double>::infinity(), ""},
      layer_distance{std::numeric_limits<double>::infinity(), ""};
  MirrorChain mirrors;
  MirrorTurns turns;
  LocatedValue max_albedo{1, ""};  // largest albedo above 1 and an object with it; 1 if no albedo is above 1
  // As max_albedo, over materials with mirrored or transmitted rays, which ray trees follow too.
  LocatedValue max_followed_albedo{1, ""};
  RoundingLimit rounding;  // strictest of all lights and materials; `reason` names the object
};

// Returns the total number of primitives in the sets.
inline std::size_t count_primitives(const std::vector<std::unique_ptr<ShapeSet>>& sets) {
  std::size_t count = 0;
  for (const auto& shapes : sets) count += static_cast<std::size_t>(shapes->size());
  return count;
}

// Shapes that one or more instances place in the scene.
struct Model {
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::int32_t> material_of;  // by primitive
};

// Transformation of an instance: scaling, then rotation, then translation.
struct Placement {
  Vec3d scale{1.0, 1.0, 1.0};
  double degrees = 0;
  Vec3d translate;
};
inline Placement mix(const Placement& before, const Placement& after, double share) {
  const double rest = 1 - share;
  return {before.scale * rest + after.scale * share, before.degrees * rest + after.degrees * share,
          before.translate * rest + after.translate * share};
}

struct Instance {
  std::size_t model;
  Vec3d axis;                   // rotation axis
  Keyframes<Placement> motion;  // one key if static

  Affined world_from_model(double time) const {
    const Placement placement = motion.at(time);
    const Affined turn = rotation(axis, placement.degrees);
    return {turn.x * placement.scale.x, turn.y * placement.scale.y, turn.z * placement.scale.z,
            placement.translate};
  }
};

// Time from the first to the last key of all moving objects, in seconds. Empty if nothing moves.
struct TimeSpan {
  double first = 0, last = 0;

  bool empty() const { return !(first < last); }
  // Returns `time` clamped to [first - seconds, last], or `first` if nothing moves. An exposure of `seconds`
  // records the same image at both times.
  double moment(double time, double seconds = 0) const {
    return empty() ? first : std::clamp(time, first - seconds, last);
  }
  // Returns true if an object may move during the exposure.
  bool within(const Exposure& exposure) const {
    return !empty() && !exposure.instant() && exposure.opens < last && exposure.closes > first;
  }
  // Returns the equivalent time within the motion if the motion repeats.
  double moment_of_loop(double time) const {
    const double held = moment(time);
    if (empty() || held == time) return held;
    const double into = std::fmod(time - first, last - first);
    return first + (into < 0 ? into + (last - first) : into);
  }
};

// Consecutive primitives that belong to one object.
struct ObjectRun {
  std::int32_t first_primitive, object;
};

// Opacity of a material: see SurfaceParams.
struct Cutout {
  double opacity = 1;  // the smallest value, if the opacity is textured
  std::optional<double> cutoff;

  bool lets_rays_pass() const { return opacity < cutoff.value_or(1); }
};

// Scene as read, in double precision. Immutable and shared between threads. Primitives are numbered set by
// set in the order of `shapes`, materials in the order of `materials`. Objects are numbered as in the scene
// file: `objects` first, then `instances`.
struct Scene {
  std::string id;  // SHA-256 of the canonical JSON
  std::string canonical;
  std::string title, description;
  std::vector<Problem> notes;  // values that were replaced while the scene was read
  CameraPlacement placement;
  std::shared_ptr<const Camera> camera;
  RenderSettings render;  // options that a scene may set; nullopt: default of the technique
  Vec3d ambient, background;
  std::shared_ptr<const Environment> environment;  // replaces the background, which is then 0; may be null
  std::shared_ptr<const Atmosphere> atmosphere;    // may be null
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::unique_ptr<MaterialSet>> materials;
  std::vector<Vec3d> emission;              // per material: radiance emitted on both sides
  std::vector<Cutout> cutouts;              // per material
  std::vector<std::string> material_names;  // per material
  std::vector<PlacedTexture> textures;
  std::vector<TextureUse> texture_uses;  // uses by all materials, in their order
  std::vector<std::unique_ptr<LightSet>> light_sets;
  std::vector<LightPlace> lights;  // in file order
  std::deque<Model> models;
  std::vector<Instance> instances;        // their primitives have numbers after those of `shapes`
  std::vector<std::int32_t> material_of;  // by primitive
  std::vector<ObjectRun> object_runs;     // in ascending order; a run ends where the next run begins
  int object_count = 0;
  TimeSpan motion;
  Media media;  // empty unless the bounds of two bodies overlap
  SceneFacts facts;

  // Returns the index in object_runs of the run that contains `primitive`.
  std::size_t object_run_of(std::int32_t primitive) const {
    const auto after =
        std::upper_bound(object_runs.begin(), object_runs.end(), primitive,
                         [](std::int32_t p, const ObjectRun& run) { return p < run.first_primitive; });
    return static_cast<std::size_t>(after - object_runs.begin()) - 1;
  }
  int primitive_count() const { return static_cast<int>(material_of.size()); }
};

}  // namespace orrery
