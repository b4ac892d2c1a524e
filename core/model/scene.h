#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/math/affine.h"
#include "core/math/keys.h"
#include "core/model/camera.h"
#include "core/model/environment.h"
#include "core/model/light.h"
#include "core/model/material.h"
#include "core/model/radiance_range.h"
#include "core/model/render_settings.h"
#include "core/model/rounding.h"
#include "core/model/shape.h"

namespace orrery {

// The largest or the smallest of the lengths of a scene, in metres, and what has it: a JSON Pointer.
struct Extreme {
  double value;
  std::string where;
};

// Mirrors among which rays go to and fro: their errors grow from one to the next.
struct MirrorChain {
  double growth = 1;  // of the error of a ray's place from one mirror to the next, times the share of light
  double radius = std::numeric_limits<double>::infinity();  // of curvature, metres
  std::string where;
};

// What the plan wants to know about a scene, computed once.
struct SceneFacts {
  MaterialTraits materials;                                          // of those that some object has
  std::size_t left_out = 0;                                          // primitives without area
  Boundsd bounds;                                                    // of the bounded primitives
  bool unbounded = false;                                            // whether there are others
  RadianceRange tree_radiance, distributed_radiance, path_radiance;  // that techniques find
  Vec3d albedo;  // the largest share that a material in use sends on of light from everywhere
  // For the choice of the number type:
  Extreme magnitude{0,
                    ""};  // largest absolute coordinate, also of the points that place unbounded primitives
  // Smallest diagonal of a bounded primitive's box, and smallest distance between two layers: the sides of
  // one body or the surfaces of two. Infinite if there is none.
  Extreme smallest_feature{std::numeric_limits<double>::infinity(), ""},
      layer_distance{std::numeric_limits<double>::infinity(), ""};
  MirrorChain mirrors;
  Extreme most_reflected{1, ""};  // share of light that a material in use sends on, and who has it
  RoundingLimit rounding;         // the strictest of lights and materials; the reason names it
};

// Primitives of all sets together.
inline std::size_t count_primitives(const std::vector<std::unique_ptr<ShapeSet>>& sets) {
  std::size_t count = 0;
  for (const auto& shapes : sets) count += static_cast<std::size_t>(shapes->size());
  return count;
}

// Shapes that instances place.
struct Model {
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::int32_t> material_of;  // of each primitive
};

// How an instance stands: scaled first, then turned, then moved.
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
  Vec3d axis;              // that it turns about
  Keys<Placement> motion;  // one key if it rests

  Affined world_from_model(double time) const {
    const Placement placement = motion.at(time);
    const Affined turn = rotation(axis, placement.degrees);
    return {turn.x * placement.scale.x, turn.y * placement.scale.y, turn.z * placement.scale.z,
            placement.translate};
  }
};

// From the first key of all that moves to the last, in seconds; equal if nothing moves.
struct TimeSpan {
  double first = 0, last = 0;

  bool empty() const { return !(first < last); }
  // The moment at which the scene looks as it does at `time`, and for so many seconds afterwards.
  double moment(double time, double seconds = 0) const {
    return empty() ? first : std::clamp(time, first - seconds, last);
  }
  // Whether something may move during an exposure.
  bool within(const Exposure& exposure) const {
    return !empty() && !exposure.instant() && exposure.opens < last && exposure.closes > first;
  }
  // The same where the motion begins again whenever it has ended.
  double moment_of_loop(double time) const {
    const double held = moment(time);
    if (empty() || held == time) return held;
    const double into = std::fmod(time - first, last - first);
    return first + (into < 0 ? into + (last - first) : into);
  }
};

// Primitives with following numbers that belong to one object.
struct ObjectRun {
  std::int32_t first_primitive, object;
};

// A scene as read, in double precision; never changed afterwards, shared between threads. Primitives are
// numbered set by set in the order of `shapes`, materials likewise in the order of `materials`. Objects are
// numbered as the scene lists them: `objects` first, then `instances`.
struct Scene {
  std::string id;  // SHA-256 of the canonical JSON
  std::string canonical;
  std::string title, description;
  CameraPlacement placement;
  std::shared_ptr<const Camera> camera;
  RenderSettings render;  // the options that scenes may give: as given, or by default
  Vec3d ambient, background;
  std::shared_ptr<const Environment> environment;  // in place of the background, which is 0 then; may be null
  std::vector<std::unique_ptr<ShapeSet>> shapes;
  std::vector<std::unique_ptr<MaterialSet>> materials;
  std::vector<Vec3d> emission;  // by material: radiance that its surfaces send out on both sides
  std::vector<std::unique_ptr<LightSet>> light_sets;
  std::vector<LightPlace> lights;  // in the order of the file
  std::deque<Model> models;
  std::vector<Instance> instances;        // their primitives are numbered after those of `shapes`
  std::vector<std::int32_t> material_of;  // of each primitive
  std::vector<ObjectRun> object_runs;     // ascending; each lasts until the next
  int object_count = 0;
  TimeSpan motion;
  SceneFacts facts;

  // The place in object_runs of what a primitive belongs to.
  std::size_t object_run_of(std::int32_t primitive) const {
    const auto after =
        std::upper_bound(object_runs.begin(), object_runs.end(), primitive,
                         [](std::int32_t p, const ObjectRun& run) { return p < run.first_primitive; });
    return static_cast<std::size_t>(after - object_runs.begin()) - 1;
  }
  int primitive_count() const { return static_cast<int>(material_of.size()); }
};

}  // namespace orrery
