#include "core/plan/warnings.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "core/accelerators/instances.h"
#include "core/model/object_pointer.h"
#include "core/model/technique.h"
#include "core/plan/plan.h"

namespace orrery {
namespace {

// Maximum numbers of primitives that one warning examines: in all, and with bounds that contain the eye. With
// these limits, all warnings take milliseconds for any scene.
constexpr int kMaxPrimitives = 20'000, kMaxAround = 8;

constexpr double kMaxReflected = 1.005;  // accepted reflectance, with a margin for rounding

std::string percents(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

// Returns whether no light can reach the eye from any surface.
bool is_unlit(const Scene& scene, const Plan& plan) {
  const MaterialTraits& used = scene.facts.materials;
  const bool surrounded = scene.background != Vec3d(0) || scene.environment;
  const bool mirrors_something = plan.specular && plan.max_depth > 0 && surrounded;
  const bool lit_from_around = plan.technique->draws_light && scene.environment;
  return !any_light_shines(scene) && scene.ambient == Vec3d(0) && !used.emits && !mirrors_something &&
         !lit_from_around;
}

// View volume of the camera: the intersection of the half-spaces of five planes.
class View {
 public:
  explicit View(const Plan& plan)
      : frame_(plan.frame),
        parallel_(plan.camera->parallel()),
        all_around_(plan.camera->all_around()),
        half_height_(plan.frame.half_extent),
        half_width_(half_height_ * plan.width / plan.height) {}

  // Returns whether the box is entirely outside one of the planes. Always false for an all-around camera.
  bool misses(const Affined& world_from_box, const Boundsd& box) const {
    if (all_around_) return false;
    std::array<bool, 5> beyond;
    beyond.fill(true);
    for (const Vec3d& corner : corners_of(box)) {
      const Vec3d from_eye = world_from_box.point(corner) - frame_.eye;
      const double depth = -dot(from_eye, frame_.back), x = dot(from_eye, frame_.right),
                   y = dot(from_eye, frame_.up);
      const double scale = parallel_ ? 1.0 : depth, right = half_width_ * scale, top = half_height_ * scale;
      const std::array<bool, 5> here{x > right, -x > right, y > top, -y > top, -depth > 0};
      for (std::size_t i = 0; i < beyond.size(); ++i) beyond[i] = beyond[i] && here[i];
    }
    return std::find(beyond.begin(), beyond.end(), true) != beyond.end();
  }

 private:
  const CameraFrame& frame_;
  bool parallel_, all_around_;
  double half_height_, half_width_;
};

// Shapes of a set at one moment.
class ShapesAt {
 public:
  ShapesAt(const ShapeSet& set, double time) : moved_(set.at(time)), shapes_(moved_ ? *moved_ : set) {}
  const ShapeSet* operator->() const { return &shapes_; }

 private:
  std::unique_ptr<ShapeSet> moved_;
  const ShapeSet& shapes_;
};

// Calls visit(shapes of one set, world_from_shapes, materials of these primitives) for each set of the scene
// and of each instance. Stops and returns true once a call returns true.
template <class Visit>
bool any_shapes(const Scene& scene, double time, const Visit& visit) {
  int first = 0;
  for (const auto& set : scene.shapes) {
    if (set->size() > 0 && visit(ShapesAt(*set, time), Affined{}, scene.material_of.data() + first))
      return true;
    first += set->size();
  }
  for (const Instance& instance : scene.instances) {
    const Model& model = scene.models[instance.model];
    int first_of_model = 0;
    for (const auto& set : model.shapes) {
      if (set->size() > 0 && visit(ShapesAt(*set, time), instance.world_from_model(time),
                                   model.material_of.data() + first_of_model))
        return true;
      first_of_model += set->size();
    }
  }
  return false;
}

// Returns whether the bounds of all primitives are outside the view. Returns false if the shutter is open for
// longer than an instant, or if there are more than kMaxPrimitives primitives.
bool nothing_in_view(const Scene& scene, const Plan& plan) {
  if (plan.shutter > 0) return false;  // motion into the view is not examined
  const View view(plan);
  int seen = 0;
  return !any_shapes(scene, plan.time, [&](const ShapesAt& shapes, const Affined& world, const auto*) {
    for (int i = 0; i < shapes->size(); ++i)
      if (++seen > kMaxPrimitives || !view.misses(world, shapes->bounds(i))) return true;
    return false;
  });
}

bool is_transparent(const Scene& scene, std::int32_t material) {
  for (const auto& set : scene.materials) {
    if (material < set->size()) return set->traits().transmits;
    material -= set->size();
  }
  return false;
}

// Tests what surrounds a point, with single rays.
class Surroundings {
 public:
  Surroundings(const Scene& scene, const Vec3d& point) : point_(point) { find_lights(scene); }

  // Returns whether the point is inside primitive `index`. REQUIRES: the primitive is closed.
  bool inside(const ShapeKernel<double>& kernel, int index, const Affined& model_from_world) {
    send({{0, 0, 1}, std::numeric_limits<double>::infinity()}, model_from_world);
    hits_.t[0] = rays_.t_max[0];
    hits_.primitive[0] = kNoPrimitive;
    AcceleratorCounts uncounted;
    kernel.closest(index, rays_, kOne, hits_, uncounted);
    if (hits_.primitive[0] == kNoPrimitive) return false;
    kernel.surface(rays_, hits_, kOne, met_);
    return met_.side[0] < 0;
  }

  // Returns whether some light source illuminates the point without being occluded by primitive `index`.
  bool lit_past(const ShapeKernel<double>& kernel, int index, const Affined& model_from_world) {
    return std::any_of(lights_.begin(), lights_.end(), [&](const ToLight& light) {
      send(light, model_from_world);
      AcceleratorCounts uncounted;
      kernel.occlude(index, rays_, kOne, uncounted);
      return rays_.t_max[0] > 0;
    });
  }

 private:
  struct ToLight {
    Vec3d direction;
    double distance;  // metres
  };

  void find_lights(const Scene& scene) {
    met_.position.set(0, point_);
    met_.normal.set(0, {0, 0, 1});
    met_.geometric.set(0, {0, 0, 1});
    Array<IndexOf<double>> slots{};
    const Draws draws(0, TileView{}, 0);
    for (const auto& set : scene.light_sets) {
      if (set->size() == 0) continue;
      const auto kernel = set->kernel(double());
      const auto arriving = std::make_unique<LightBatch<double>>();
      for (int i = 0; i < set->size(); ++i) {
        if (set->intensity(i) == Vec3d(0)) continue;
        kernel->sample(met_, {i}, {draws, slots, 0}, kOne, *arriving);
        const double distance = arriving->shadow.t_max[0];
        if (distance > 0) lights_.push_back({arriving->shadow.direction[0], distance});
      }
    }
  }
  void send(const ToLight& ray, const Affined& model_from_world) {
    rays_.count = 1;
    rays_.set(0, {model_from_world.point(point_), model_from_world.vector(ray.direction)}, ray.distance);
  }

  static inline const LaneGroups kOne = LaneGroups::single(0);
  const Vec3d point_;
  std::vector<ToLight> lights_;
  RayBatch<double> rays_{};
  HitBatch<double> hits_{};
  SurfaceBatch<double> met_{};
};

// Returns whether at least two primitives have bounds that overlap `bounds`: the primitive that `bounds`
// belongs to, and another one. Unbounded primitives overlap all bounds. Also returns true if the scene has
// more than kMaxPrimitives primitives.
bool holds_others(const Scene& scene, const Plan& plan, const Boundsd& bounds) {
  int overlapping = 0, seen = 0;
  return any_shapes(scene, plan.time, [&](const ShapesAt& shapes, const Affined& world, const auto*) {
    for (int i = 0; i < shapes->size(); ++i) {
      const Boundsd box = shapes->bounds(i);
      overlapping += !box.bounded() || box_around(box, world).overlaps(bounds);
      if (overlapping > 1 || ++seen > kMaxPrimitives) return true;
    }
    return false;
  });
}

// Returns whether the eye is inside a closed opaque shape without emission that hides all light sources. If
// the scene has ambient light or emission, the shape must also contain no other primitive. Examines at most
// kMaxPrimitives primitives of closed shapes, and at most kMaxAround opaque ones whose bounds contain the
// eye.
bool is_enclosed(const Scene& scene, const Plan& plan) {
  const bool glows = scene.ambient != Vec3d(0) || scene.facts.materials.emits;
  int seen = 0, around = 0;
  bool enclosed = false;
  std::unique_ptr<Surroundings> surroundings;
  any_shapes(scene, plan.time,
             [&](const ShapesAt& shapes, const Affined& world, const std::int32_t* materials) {
               if (!shapes->traits().closed || scaled_determinant(world) == 0) return false;
               const Affined model_from_world = inverse(world);
               const Vec3d eye = model_from_world.point(plan.frame.eye);
               ShapeKernelPtr<double> kernel;
               for (int i = 0; i < shapes->size(); ++i) {
                 if (++seen > kMaxPrimitives) return true;
                 if (!shapes->bounds(i).contains(eye) || is_transparent(scene, materials[i])) continue;
                 if (scene.emission[static_cast<std::size_t>(materials[i])] != Vec3d(0)) continue;
                 if (++around > kMaxAround) return true;
                 if (!kernel) kernel = shapes->kernel(double(), 0);
                 if (!surroundings) surroundings = std::make_unique<Surroundings>(scene, plan.frame.eye);
                 if (!surroundings->inside(*kernel, i, model_from_world) ||
                     surroundings->lit_past(*kernel, i, model_from_world))
                   continue;
                 enclosed = !glows || !holds_others(scene, plan, box_around(shapes->bounds(i), world));
                 return true;
               }
               return false;
             });
  return enclosed;
}

// Returns the number of the first primitive whose material has a specular lobe, or -1 if the first
// kMaxPrimitives primitives have none.
int smooth_primitive(const Scene& scene) {
  std::vector<char> smooth;  // indexed by material
  for (const auto& set : scene.materials) {
    const MaterialTraits traits = set->traits();
    for (int i = 0; i < set->size(); ++i)
      smooth.push_back(traits.mirrors && (!traits.lit || traits.straight || set->mirrored_share(i) > 0));
  }
  const int last = std::min(scene.primitive_count(), kMaxPrimitives);
  for (int p = 0; p < last; ++p)
    if (smooth[static_cast<std::size_t>(scene.material_of[static_cast<std::size_t>(p)])]) return p;
  return -1;
}

// Returns whether a sampled direction may hit the light.
bool can_be_hit(const LightSet& lights, int index) {
  return lights.traits().parallel ? lights.extended(index) : !lights.traits().delta;
}

// Returns a warning about the first light that no sampled direction can hit. Its caustics are lost: a path
// that reaches the light by way of a specular surface has probability 0. `detail` is empty unless
// loses_caustics() is true; see there for the conditions.
Problem lost_caustic(const Scene& scene, const Plan& plan) {
  if (!plan.technique->interreflects || !scene.facts.materials.lit || plan.max_depth < 2) return {};
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& [set, index] = scene.lights[i];
    const LightSet& lights = *scene.light_sets[set];
    const bool parallel = lights.traits().parallel;
    if (lights.intensity(index) == Vec3d(0)) continue;
    if (can_be_hit(lights, index)) continue;
    const int smooth = smooth_primitive(scene);
    if (smooth < 0) return {};
    char instead[96];
    if (parallel)
      std::snprintf(instead, sizeof instead, "set angle_degrees to 0.53 (the sun)");
    else
      std::snprintf(instead, sizeof instead, "use a sphere lamp of radius %.1g m instead",
                    0.01 * (scene.facts.bounds.bounded() ? scene.facts.bounds.diagonal() : 1.0));
    return {"/lights/" + std::to_string(i),
            "caustics of this light via " + pointer_to_object(scene, smooth) +
                " are not rendered (no path can hit a light without extent); " + instead};
  }
  return {};
}

// Returns a warning about the material that creates most energy, or an empty one. Ray trees follow only
// mirrored and transmitted rays, so that they create energy only at materials with such rays.
Problem created_energy(const Scene& scene, const Plan& plan) {
  const bool followed = plan.specular && plan.technique->secondary_rays;
  if (plan.technique->draws_light && scene.facts.max_albedo.value > scene.facts.max_followed_albedo.value) {
    const LocatedValue& most = scene.facts.max_albedo;
    if (most.value > kMaxReflected)
      return {most.where + "/material",
              "material reflects up to " + percents(most.value) +
                  " of the incoming light; plastic and non-strict metallic-roughness conserve energy"};
  }
  const LocatedValue& most = scene.facts.max_followed_albedo;
  if ((!followed && !plan.technique->draws_light) || most.value <= kMaxReflected) return {};
  return {most.where + "/material",
          "material reflects and transmits up to " + percents(most.value) + " of the incoming light"};
}

// Returns whether all used materials whose bodies scatter light have smooth surfaces.
bool scatters_behind_smooth_surfaces(const Scene& scene) {
  std::vector<char> used;
  for (const std::int32_t material : scene.material_of) {
    if (static_cast<std::size_t>(material) >= used.size())
      used.resize(static_cast<std::size_t>(material) + 1);
    used[static_cast<std::size_t>(material)] = 1;
  }
  std::size_t number = 0;
  for (const auto& set : scene.materials)
    for (int i = 0; i < set->size(); ++i, ++number) {
      const auto medium = set->medium(i);
      if (medium && medium->scatters() && number < used.size() && used[number] && !set->limits(i).specular)
        return false;
    }
  return true;
}

// Returns a warning about bodies that scatter light: the technique does not scatter, or no light enters.
Problem missing_scattering(const Scene& scene, const Plan& plan) {
  const Media& media = scene.media;
  if (!plan.media || !media.scatters()) return {};
  if (!plan.scatters)
    return {media.scattering, std::string(plan.technique->name) +
                                  " does not scatter light inside bodies, so they are darker; set technique "
                                  "to path"};
  const bool surrounded = scene.background != Vec3d(0) || scene.environment;
  if (surrounded || scene.facts.materials.emits || !any_light_shines(scene)) return {};
  for (const auto& [set, index] : scene.lights)
    if (scene.light_sets[set]->intensity(index) != Vec3d(0) && can_be_hit(*scene.light_sets[set], index))
      return {};
  if (!scatters_behind_smooth_surfaces(scene)) return {};
  return {media.scattering,
          "no light enters the body (no path through a smooth surface can hit a light without extent); use a "
          "lamp, or set roughness to 0.2"};
}

std::vector<Problem> warnings(const Scene& scene, const Plan& plan, bool empty) {
  std::vector<Problem> found = scene.notes;
  if (is_unlit(scene, plan))
    found.push_back({"/lights", "scene has no light source and no ambient light; every surface is black"});
  if (!plan.camera->parallel() && !scene.facts.cutouts && is_enclosed(scene, plan))
    found.push_back({"/camera/eye", "camera is inside an opaque shape that contains no light"});
  if (Problem creates = created_energy(scene, plan); !creates.detail.empty())
    found.push_back(std::move(creates));
  if (Problem lost = lost_caustic(scene, plan); !lost.detail.empty()) found.push_back(std::move(lost));
  if (Problem dark = missing_scattering(scene, plan); !dark.detail.empty()) found.push_back(std::move(dark));
  if (empty) found.push_back({"/camera", "nothing is in view; the image shows only the background"});
  return found;
}

}  // namespace

bool loses_caustics(const Scene& scene, const Plan& plan) {
  return !lost_caustic(scene, plan).detail.empty();
}

std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan) {
  return warnings(scene, plan, nothing_in_view(scene, plan));
}

std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan, const TraceCounts& traced) {
  // Camera rays that are scattered in a body of index 1 hit no surface.
  return warnings(scene, plan, traced.camera_hits == 0 && traced.scatterings == 0);
}

}  // namespace orrery
