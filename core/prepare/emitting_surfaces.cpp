#include "core/prepare/emitting_surfaces.h"

#include <optional>
#include <utility>
#include <vector>

#include "core/base/task_scope.h"
#include "core/lights/emitters.h"

namespace orrery {
namespace {

template <class T>
class EmitterList {
 public:
  EmitterList(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry)
      : scene_(scene), exposure_(exposure), geometry_(geometry) {}

  // Finds the emitters of the shape sets of the scene, then those of its instances. Returns their bounds.
  std::vector<LightBounds> find() {
    for (const auto& shapes : scene_.shapes) {
      const auto last = primitive_ + static_cast<std::size_t>(shapes->size());
      if (skip_to_emitter(last)) {  // skips at() for sets without emitters
        const auto posed = shapes->at(exposure_.opens);
        add(*shapes, posed ? *posed : *shapes, last, nullptr);
      }
    }
    const bool few = emits_at_most(kMaxInstancedEmitters);
    for (const Instance& instance : scene_.instances) {
      const Model& model = scene_.models[instance.model];
      const bool moves = !exposure_.instant() && instance.motion.times.size() > 1;
      const Affined world_from_model = instance.world_from_model(exposure_.opens);
      for (const auto& shapes : model.shapes) {
        const auto last = primitive_ + static_cast<std::size_t>(shapes->size());
        if (!skip_to_emitter(last)) continue;
        if (few && !moves && shapes->key_times().empty()) {
          add(*shapes, *shapes, last, &world_from_model);
        } else {
          geometry_.emits_undrawn = true;
          primitive_ = last;
        }
      }
    }
    if (!emitters_.empty()) geometry_.emitters = make_emitters<T>(emitters_);
    return std::move(bounds_);
  }

 private:
  Vec3d radiance_of(std::size_t primitive) const {
    return scene_.emission[static_cast<std::size_t>(scene_.material_of[primitive])];
  }

  // Advances primitive_ to the next emitting primitive. Returns false if there is none before `last`.
  bool skip_to_emitter(std::size_t last) {
    while (primitive_ < last && radiance_of(primitive_) == Vec3d(0)) checkpoint(++primitive_);
    return primitive_ < last;
  }

  // Returns true if at most `most` primitives from primitive_ on emit.
  bool emits_at_most(std::size_t most) const {
    std::size_t count = 0;
    for (std::size_t p = primitive_; p < scene_.material_of.size() && count <= most; ++p) {
      checkpoint(p);
      count += radiance_of(p) != Vec3d(0);
    }
    return count <= most;
  }

  // Adds the emitters of a set, from primitive_ to `last` - 1. `now` contains the shapes at the start of the
  // exposure. world_from_model is null if the set is not part of an instance.
  void add(const ShapeSet& shapes, const ShapeSet& now, std::size_t last, const Affined* world_from_model) {
    for (int i = now.size() - static_cast<int>(last - primitive_); primitive_ < last; ++i, ++primitive_) {
      checkpoint(primitive_);
      if (radiance_of(primitive_) == Vec3d(0)) continue;
      const bool moves = !exposure_.instant() && shapes.moves(i);
      const auto emitter = moves ? std::nullopt : emitter_of(now, i, world_from_model);
      if (!emitter || !(emitter->area > 0)) {
        geometry_.emits_undrawn = true;
        continue;
      }
      geometry_.emits_undrawn |= emitter->is_solid();
      geometry_.emitter_of[primitive_] = static_cast<IndexOf<T>>(emitters_.size());
      bounds_.push_back(bounds_of(*emitter));
      emitters_.push_back(*emitter);
    }
  }
  std::optional<Emitter<double>> emitter_of(const ShapeSet& now, int index,
                                            const Affined* world_from_model) const {
    const auto patch = now.patch(index);
    if (!patch || !is_uniform(static_cast<std::size_t>(scene_.material_of[primitive_]))) return {};
    const Vec3d radiance = radiance_of(primitive_);
    if (world_from_model) return make_emitter(*patch, radiance, *world_from_model);
    const Emitter<double> emitter = make_emitter(*patch, radiance);
    if (emitter.is_solid() && holds_all(now.bounds(index))) return {};
    return emitter;
  }
  // Returns true if the whole surface emits the same radiance.
  bool is_uniform(std::size_t material) const {
    return !scene_.cutouts[material].lets_rays_pass() &&
           (geometry_.has_textured_emission.empty() || !geometry_.has_textured_emission[material]);
  }
  // Returns true if the scene has several primitives, all bounded, and the box contains them. A solid with
  // this box surrounds all other primitives, and a SolidEmitter cannot be sampled from inside.
  bool holds_all(const Boundsd& box) const {
    const Boundsd& all = scene_.facts.bounds;
    return scene_.material_of.size() > 1 && !scene_.facts.unbounded && box.contains(all.lo) &&
           box.contains(all.hi);
  }

  const Scene& scene_;
  const Exposure& exposure_;
  Geometry<T>& geometry_;
  std::size_t primitive_ = 0;
  std::vector<Emitter<double>> emitters_;
  std::vector<LightBounds> bounds_;
};

}  // namespace

template <class T>
std::vector<LightBounds> add_emitters(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry) {
  if (!scene.facts.materials.emits) return {};
  geometry.emitter_of.assign(geometry.material_of.size(), -1);
  return EmitterList<T>(scene, exposure, geometry).find();
}

template std::vector<LightBounds> add_emitters(const Scene&, const Exposure&, Geometry<float>&);
template std::vector<LightBounds> add_emitters(const Scene&, const Exposure&, Geometry<double>&);

}  // namespace orrery
