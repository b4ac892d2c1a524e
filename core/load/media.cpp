#include "core/load/media.h"

#include <algorithm>
#include <numeric>

#include "core/accelerators/instances.h"
#include "core/base/task_scope.h"
#include "core/model/object_pointer.h"

namespace orrery {
namespace {

// Maximum number of pairs of bodies that are compared, per body. Beyond it, the bodies count as overlapping.
constexpr std::size_t kMaxPairs = 64;
constexpr std::size_t kMaxTouching = 16;  // per body

// Returns whether the boxes have faces in one plane. Half-spaces may touch any box.
bool may_touch(const Boundsd& a, const Boundsd& b) {
  const auto along = [](double al, double ah, double bl, double bh) {
    return al == bl || al == bh || ah == bl || ah == bh;
  };
  return !a.bounded() || !b.bounded() || along(a.lo.x, a.hi.x, b.lo.x, b.hi.x) ||
         along(a.lo.y, a.hi.y, b.lo.y, b.hi.y) || along(a.lo.z, a.hi.z, b.lo.z, b.hi.z);
}

class MediaFinder {
 public:
  explicit MediaFinder(const Scene& scene) : scene_(scene) {
    for (std::size_t set = 0; set < scene.materials.size(); ++set)
      for (int i = 0; i < scene.materials[set]->size(); ++i) {
        media_.push_back(scene.materials[set]->medium(i));
        if (media_.back() && scene.emission[media_.size() - 1] != Vec3d(0))
          media_.back()->refracts_only = false;
      }
  }

  Media find() {
    const auto enclosing = [](const auto& medium) { return medium.has_value(); };
    if (std::none_of(media_.begin(), media_.end(), enclosing)) return {};
    found_.body_of.assign(scene_.material_of.size(), -1);
    add_sets(scene_.shapes, nullptr);
    for (const Instance& instance : scene_.instances)
      add_sets(scene_.models[instance.model].shapes, &instance);
    return compare() ? std::move(found_) : Media{};
  }

 private:
  // Adds the shapes of the scene, or of an instance. Primitives have the numbers from number_ on.
  void add_sets(const std::vector<std::unique_ptr<ShapeSet>>& sets, const Instance* instance) {
    for (const auto& shapes : sets) {
      for (int i = 0; i < shapes->size();) {
        checkpoint(static_cast<std::size_t>(i));
        const auto& medium = media_[material_of(i)];
        const Shell shell = medium ? shapes->shell(i) : Shell{i + 1, false};
        if (medium)
          add_body(*medium, shell, *shapes, i, instance);
        else if (instance == nullptr)
          add_solid(*shapes, i);
        i = shell.last;
      }
      number_ += shapes->size();
    }
  }
  std::size_t material_of(int index) const {
    return static_cast<std::size_t>(scene_.material_of[static_cast<std::size_t>(number_ + index)]);
  }

  void add_body(const Medium& medium, const Shell& shell, const ShapeSet& shapes, int first,
                const Instance* instance) {
    const auto body = static_cast<std::int32_t>(found_.bodies.size());
    Boundsd box;
    for (int i = first; i < shell.last; ++i) {
      checkpoint(static_cast<std::size_t>(i));
      found_.body_of[static_cast<std::size_t>(number_ + i)] = body;
      box.include(shapes.reach(i).box);
    }
    if (instance && box.bounded())
      box = instance->motion.times.size() > 1 ? Boundsd::everything()
                                              : box_around(box, instance->world_from_model(0));
    if (shell.closed && medium.scatters() && found_.scattering.empty())
      found_.scattering = pointer_to_object(scene_, number_ + first);
    found_.bodies.push_back(medium);
    found_.closed.push_back(shell.closed);
    found_.bounds.push_back(box);
    found_.primitive_of.push_back(number_ + first);
    found_.touching.emplace_back();
    single_.push_back(instance == nullptr && shell.last == first + 1);
  }
  // Records the box of an opaque primitive.
  void add_solid(const ShapeSet& shapes, int index) {
    const Boundsd box = shapes.reach(index).box;
    if (box.bounded()) solids_.push_back({box, number_ + index});
  }

  // Returns whether media must be tracked, and sets Media::touching, `where` and `other`.
  bool compare() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < found_.bodies.size(); ++i)
      if (found_.closed[i]) order.push_back(i);
    const auto low = [&](std::size_t body) { return found_.bounds[body].lo.x; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
    std::size_t left = kMaxPairs * order.size();
    bool nested = false;
    for (std::size_t i = 0; i < order.size(); ++i) {
      checkpoint(i);
      const Boundsd& box = found_.bounds[order[i]];
      for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= box.hi.x; ++j) {
        if (left-- == 0) {
          name(order[i], order[j]);
          return true;
        }
        if (!box.overlaps(found_.bounds[order[j]])) continue;
        if (!nested) name(order[i], order[j]);
        nested = true;
        if (may_touch(box, found_.bounds[order[j]])) join(order[i], order[j]);
      }
    }
    return nested || absorbs_around_solid() || found_.scatters();
  }
  // Returns whether an opaque primitive may be inside a body that absorbs light.
  bool absorbs_around_solid() {
    std::size_t left = kMaxPairs * (found_.bodies.size() + solids_.size());
    for (std::size_t i = 0; i < found_.bodies.size(); ++i) {
      if (!found_.closed[i] || found_.bodies[i].log2_filter == Vec3d(0)) continue;
      for (const auto& [box, number] : solids_) {
        checkpoint();
        if (left > 0) --left;
        if (left > 0 && !found_.bounds[i].contains(box)) continue;
        found_.where = pointer_to_object(scene_, found_.primitive_of[i]);
        found_.other = pointer_to_object(scene_, number);
        return true;
      }
    }
    return false;
  }
  void name(std::size_t first, std::size_t second) {
    found_.where = pointer_to_object(scene_, found_.primitive_of[first]);
    found_.other = pointer_to_object(scene_, found_.primitive_of[second]);
  }
  void join(std::size_t first, std::size_t second) {
    if (!single_[first] || !single_[second]) return;
    const auto add = [&](std::size_t to, std::size_t body) {
      if (found_.touching[to].size() < kMaxTouching)
        found_.touching[to].push_back(static_cast<std::int32_t>(body));
    };
    add(first, second);
    add(second, first);
  }

  struct Solid {
    Boundsd box;
    int primitive;
  };
  const Scene& scene_;
  std::vector<std::optional<Medium>> media_;  // by material
  Media found_;
  std::vector<bool> single_;  // by body: whether it is one primitive of the scene itself
  std::vector<Solid> solids_;
  int number_ = 0;
};

}  // namespace

Media find_media(const Scene& scene) { return MediaFinder(scene).find(); }

}  // namespace orrery
