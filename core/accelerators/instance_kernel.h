#pragma once

#include <algorithm>

#include "core/model/accelerator.h"

// Instances as primitives, static or moving. An Instance<T> has
//   std::shared_ptr<const ModelGeometry<T>> model;
//   int first, last;                primitives of the instance: numbers [first, last) in the scene
//   T step_scale, step_base;        world SurfaceBatch::step: step_scale * step in the model + step_base
//   static constexpr bool kTimed;   whether the pose depends on the rays' time
//   Pose pose(rays, i) const;       transforms for register i: to_model(ray), and to the world
//                                   point(p), vector(v), normal(n), without normalisation
namespace orrery {

// Rays in the coordinates of one model, and their hits on the primitives of the model.
template <class T>
struct ModelVisit {
  using N = Lanes<T>;
  RayBatch<T> rays;
  HitBatch<T> hits;

  void put(int i, const Ray<N>& ray, const N& t) {
    rays.origin.put(i, ray.origin);
    rays.direction.put(i, ray.direction);
    rays.t_max.put(i, t);
    hits.t.put(i, t);
    hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
  }
};

// Hits of register i in an instance's model. `nearer` marks the lanes whose hit replaces (best, best_id).
// `id` is the primitive's number in the scene. `first` is the number of the instance's first primitive.
template <class T>
struct TakenHits {
  using N = Lanes<T>;
  MaskOf<N> nearer;
  N t;
  IndexLanes<T> id;

  TakenHits(int first, const ModelVisit<T>& visit, int i, const N& best, const IndexLanes<T>& best_id)
      : t(visit.hits.t.at(i)) {
    const IndexLanes<T> in_model = load_index<T>(visit.hits.primitive, i);
    id = in_model + IndexOf<T>(first);
    const auto met = mask_cast<N>(in_model != IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
    nearer = met && is_nearer_hit(t, id, best, best_id);
  }
};

template <class T, class Instance>
class InstanceKernelOf : public ShapeKernel<T> {
 public:
  using N = Lanes<T>;
  using List = std::vector<Instance>;

  // REQUIRES: `placed` is sorted by primitive number.
  explicit InstanceKernelOf(List placed) : placed_(std::make_shared<const List>(std::move(placed))) {}

  bool timed() const override { return Instance::kTimed; }
  std::vector<HullTriangle> hull(int) const override { return {}; }

  void closest(int index, const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    const Instance& placed = (*placed_)[static_cast<std::size_t>(index)];
    const std::unique_ptr<ModelVisit<T>> visit(new ModelVisit<T>);
    visit->rays.count = rays.count;
    for (const int i : groups) enter(placed, rays, i, hits.t.at(i), *visit);
    placed.model->accelerator->closest(visit->rays, groups, visit->hits, counts);
    for (const int i : groups) {
      const TakenHits<T> taken(placed.first, *visit, i, hits.t.at(i), load_index<T>(hits.primitive, i));
      hits.t.put(i, taken.nearer, taken.t);
      hits.primitive.put(i, mask_cast<IndexLanes<T>>(taken.nearer), taken.id);
    }
  }

  void occlude(int index, RayBatch<T>& rays, const LaneGroups& groups,
               AcceleratorCounts& counts) const override {
    const Instance& placed = (*placed_)[static_cast<std::size_t>(index)];
    const std::unique_ptr<ModelVisit<T>> visit(new ModelVisit<T>);
    visit->rays.count = rays.count;
    for (const int i : groups) enter(placed, rays, i, rays.t_max.at(i), *visit);
    placed.model->accelerator->occlude(visit->rays, groups, counts);
    for (const int i : groups) rays.t_max.put(i, visit->rays.t_max.at(i));
  }

  void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
               SurfaceBatch<T>& out) const override {
    const auto take = [&](int i, const auto& mask, const auto& pose, const Instance& placed,
                          LocalHits& local) {
      for (const auto& shapes : placed.model->shapes)
        shapes->surface(local.rays, local.hits, LaneGroups::single(i), local.surface);
      out.position.put(i, mask, pose.point(local.surface.position.at(i)));
      out.geometric.put(i, mask, normalize(pose.normal(local.surface.geometric.at(i))));
      out.normal.put(i, mask, normalize(pose.normal(local.surface.normal.at(i))));
      out.side.put(i, mask, local.surface.side.at(i));
      out.step.put(i, mask, N(local.surface.step.at(i) * N(placed.step_scale) + N(placed.step_base)));
    };
    for_each_hit(rays, hits, groups, take);
  }

  // The curved surface of a model transforms with the model. A normal of 0 marks lanes without one.
  void smooth(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
              SurfaceBatch<T>& out) const override {
    const N zero(T(0));
    const auto take = [&](int i, const auto& mask, const auto& pose, const Instance& placed,
                          LocalHits& local) {
      local.surface.smooth.put(i, Vec3<N>(zero));
      for (const auto& shapes : placed.model->shapes)
        shapes->smooth(local.rays, local.hits, LaneGroups::single(i), local.surface);
      const Vec3<N> normal = local.surface.smooth.at(i);
      const auto curved = mask && max_component(abs(normal)) > zero;
      if (!any(curved)) return;
      out.smooth.put(i, curved, normalize(pose.normal(normal)));
      out.lift.put(i, curved, pose.vector(local.surface.lift.at(i)));
    };
    for_each_hit(rays, hits, groups, take);
  }

  // Colours of 1 mark lanes without vertex colours.
  void colors(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
              SurfaceBatch<T>& out) const override {
    const auto take = [&](int i, const auto& mask, const auto&, const Instance& placed, LocalHits& local) {
      local.surface.color.put(i, Vec3<N>(N(T(1))));
      for (const auto& shapes : placed.model->shapes)
        shapes->colors(local.rays, local.hits, LaneGroups::single(i), local.surface);
      out.color.put(i, mask, local.surface.color.at(i));
    };
    for_each_hit(rays, hits, groups, take);
  }

  void parameters(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                  SurfaceBatch<T>& out) const override {
    const auto take = [&](int i, const auto& mask, const auto& pose, const Instance& placed,
                          LocalHits& local) {
      for (const auto& shapes : placed.model->shapes) {
        shapes->surface(local.rays, local.hits, LaneGroups::single(i), local.surface);
        shapes->parameters(local.rays, LaneGroups::single(i), local.hits, local.surface);
      }
      hits.u.put(i, mask, local.hits.u.at(i));
      hits.v.put(i, mask, local.hits.v.at(i));
      out.u.put(i, mask, local.surface.u.at(i));
      out.v.put(i, mask, local.surface.v.at(i));
      out.tangent.put(i, mask, normalize(pose.vector(local.surface.tangent.at(i))));
    };
    for_each_hit(rays, hits, groups, take);
  }

 protected:
  std::shared_ptr<const List> placed_;

 private:
  // Hits in the coordinates of a model, and the surfaces there.
  struct LocalHits : ModelVisit<T> {
    SurfaceBatch<T> surface;
  };

  // Stores the rays of register i in `visit`, in model coordinates. Returns the pose.
  static auto enter(const Instance& placed, const RayBatch<T>& rays, int i, const N& t,
                    ModelVisit<T>& visit) {
    const auto pose = placed.pose(rays, i);
    visit.put(i, pose.to_model(rays.at(i)), t);
    if constexpr (Instance::kTimed) visit.rays.time.put(i, rays.time.at(i));
    return pose;
  }

  // Calls visit(i, mask, pose, instance, local) for each register i of `groups` and each instance that a lane
  // of the register hits. `mask` selects these lanes. `local` holds their rays and hits in the coordinates of
  // the model.
  template <class Visit>
  void for_each_hit(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
                    const Visit& visit) const {
    const std::unique_ptr<LocalHits> local(new LocalHits);
    local->rays.count = rays.count;
    const auto owner = [this](IndexOf<T> id) {
      return std::upper_bound(placed_->begin(), placed_->end(), id,
                              [](IndexOf<T> number, const Instance& p) { return number < p.last; });
    };
    for (const int i : groups) {
      const IndexLanes<T> id = load_index<T>(hits.primitive, i);
      auto open = id >= IndexOf<T>(placed_->front().first) && id < IndexOf<T>(placed_->back().last);
      while (any(open)) {
        const IndexOf<T> one = id[static_cast<std::size_t>(stdx::find_first_set(open))];
        const Instance& placed = *owner(one);
        const auto here = open && id >= IndexOf<T>(placed.first) && id < IndexOf<T>(placed.last);
        open = open && !here && id != one;
        if (!any(here)) continue;  // the lane hits a primitive of another kernel
        IndexLanes<T> hit(IndexOf<T>{kNoPrimitive});
        stdx::where(here, hit) = id - IndexOf<T>(placed.first);
        const auto pose = enter(placed, rays, i, hits.t.at(i), *local);
        local->hits.primitive.put(i, hit);
        visit(i, mask_cast<N>(here), pose, placed, *local);
      }
    }
  }
};

}  // namespace orrery
